# SPDX-License-Identifier: MIT
"""Commands and groups of commands: `-h`, whole summaries in the help, no option given twice."""

import inspect
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from importlib.metadata import version
from itertools import pairwise
from typing import Annotated, Any, Final, TypeAlias

import typer
from typer.core import TyperCommand, TyperGroup

from model.similar_name import similar_name
from zebro_lab.files.provenance import software_commit
from zebro_lab.terminal.removed import replacement

SETTINGS: Final = {"help_option_names": ["-h", "--help"]}
_EXPECTED: Final = {
    "float": "a number", "int": "a whole number", "bool": "true or false", "path": "a path",
}  # fmt: skip


class _Strict:
    """What commands and groups share: options are given once, and summaries are whole."""

    help: str | None

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse arguments as Typer does, after a check that no option is given twice.

        To the message of a Typer error is added which option was probably meant, or what replaced
        it; a value of another type is reported with the type expected.

        Raises:
            BadParameter: An option that takes one value is given more than once.
        """
        words = tuple(args)
        try:
            _require_single(self, ctx, args)
            typer_class: Any = super()  # comes after this class among the bases
            return typer_class.parse_args(ctx, args)
        except Exception as error:
            unknown: Any = error
            if hasattr(unknown, "possibilities"):  # Typer's own are other options as well
                unknown.possibilities = None
                _offer(unknown, _name(ctx), unknown.option_name, _options(self, ctx))
            elif hasattr(error.__cause__, "errors"):  # by pydantic
                unknown.message = _named_value(unknown.message, unknown.__cause__.errors()[0])
            for option_and_value in map(" ".join, pairwise(words)):  # a removed value
                _offer(unknown, _name(ctx), option_and_value, ())
            raise

    def get_short_help_str(self, limit: int = 45) -> str:
        """Return the first sentence of the help, not shortened to `limit` characters."""
        return _summary(self.help)


class StrictCommand(_Strict, TyperCommand):
    """Command that refuses an option given twice and shows plain metavars in its help."""

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the parts of the usage line, without braces around required arguments."""
        return [re.sub(r"[{}]", "", piece) for piece in super().collect_usage_pieces(ctx)]

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the help of arguments, then of options, with their metavars."""
        arguments, options = [], []
        for param in self.get_params(ctx):
            record = param.get_help_record(ctx)
            if record is None:
                continue
            if param.param_type_name == "argument":
                name = param.metavar or param.name
                arguments.append((name + "..." * (param.nargs != 1), record[1]))
            else:
                options.append(record)
        for title, rows in (("Arguments", arguments), ("Options", options)):
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)


class Group(_Strict, TyperGroup):
    """Group of commands that lists them with whole summaries, and offers one that was misspelt."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find a command as Typer does, with the name that an unknown one means in the message."""
        known = self.list_commands(ctx)
        try:
            return super().resolve_command(ctx, args)
        except Exception as error:
            if args[0] not in known:
                _offer(error, _name(ctx), args[0], known)
            raise


class Application(typer.Typer):
    """Typer application whose commands and groups are those of this module.

    Args:
        settings: Settings of `typer.Typer`, which override those of all our applications.
    """

    def __init__(self, **settings: Any) -> None:
        super().__init__(
            **{
                "cls": Group,
                "suggest_commands": False,  # it offers other commands as well
                "context_settings": SETTINGS,
                "rich_markup_mode": None,
                "pretty_exceptions_enable": False,
                **settings,
            }
        )

    def command(self, name: str | None = None, **settings: Any) -> Callable[..., Any]:
        """Return the decorator that adds a function as a command, as `typer.Typer.command`."""
        return super().command(
            name, **{"cls": StrictCommand, "context_settings": SETTINGS, **settings}
        )


def _offer(error: Any, path: str, name: str, known: Collection[str]) -> None:
    """Add to the message what replaced a removed name, or else the known name that it resembles."""
    near = similar_name(name, known)
    advice = replacement(path, name) or (f"Did you mean '{near}'?" if near else None)
    if hasattr(error, "message") and advice:
        error.message = f"{error.message.rstrip('.')}. {advice}"


def _named_value(message: str, found: Mapping[str, Any]) -> str:
    """Return a message with the value that pydantic rejects, and what is expected if known."""
    kind = str(found.get("type", "")).split("_")[0]
    if kind in _EXPECTED:
        return f"found '{found.get('input')}'; expected {_EXPECTED[kind]}"
    return message.removeprefix("Value error, ")


def _name(ctx: Any) -> str:
    """Return the name of a command with those of its groups, without the program's: `rig run`."""
    if ctx.parent is not None:
        return f"{_name(ctx.parent)} {ctx.command.name}".strip()
    return "" if isinstance(ctx.command, Group) else ctx.command.name


def _options(command: Any, ctx: Any) -> list[str]:
    """Return the names of all options of a command, such as `--out` and `-h`."""
    return [
        name
        for param in command.get_params(ctx)
        for name in (*param.opts, *param.secondary_opts)
        if name.startswith("-")
    ]


def _require_single(command: Any, ctx: Any, args: Sequence[str]) -> None:
    """Raise `BadParameter` if an option that takes one value is given twice; flags may be repeated.

    Flags with an opposite, such as `--x/--no-x`, may not.
    """
    _, _, given = command.make_parser(ctx).parse_args(args=list(args))
    for param, times in Counter(given).items():
        is_plain_flag = getattr(param, "is_flag", False) and not param.secondary_opts
        if param.param_type_name == "argument" or param.multiple or is_plain_flag or times < 2:
            continue
        raise typer.BadParameter("given twice; give it once", ctx=ctx, param=param)


def _summary(text: str | None) -> str:
    """Return the first paragraph of a help text in one line, up to its first full stop."""
    paragraph = " ".join(inspect.cleandoc(text or "").split("\n\n")[0].split())
    return paragraph.split(". ")[0].rstrip(".")


def _print_version(wanted: bool) -> None:
    """Print version and commit and exit, if `--version` is given."""
    if wanted:
        typer.echo(f"zebro-lab {version('zebro-lab')}, commit {software_commit()}")
        raise typer.Exit


Version: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--version",
        callback=_print_version,
        is_eager=True,
        help="Print version and commit of the software, and exit.",
    ),
]
