# SPDX-License-Identifier: MIT
"""`zebro-lab init FILE`: write a `columns.toml` from a table's header, or a template."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

if TYPE_CHECKING:
    from zebro_lab.exchange.init_stage import WrittenColumns


@request_command()
def init(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="Table whose header is read; of kind ground or robot the file to write.",
        ),
    ],
    kind: Annotated[
        Literal["rig", "legs", "imu", "track", "ground", "robot"] | None,
        typer.Option(
            help="What the table holds; default: told from its headers. ground, robot: no table, "
            "write FILE, a ground.toml or robot.toml to edit."
        ),
    ] = None,
    sheet: Annotated[
        str | None, typer.Option(help="Sheet of a workbook; default: the only one.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
    output: Output = TEXT,
) -> None:
    """Write a commented columns.toml to the folder of FILE, guessed from its header.

    What is not sure ends in "?" there; no command reads the table until somebody deleted it. With
    --kind ground or robot write FILE itself, a commented ground.toml of level ground, or a
    robot.toml of the thesis's robot.
    """
    from zebro_lab.exchange.init_stage import write_columns_template, write_template

    if kind == "ground" or kind == "robot":
        if sheet is not None:
            raise typer.BadParameter(f"is of a workbook; a {kind} has none", param_hint="'--sheet'")
        template = write_template(file, kind, force=force)
        output.say(f"wrote {template}, a {kind} to edit; then:")
        output.say(f"  zebro-lab walk --{kind} {template} --slip thesis --duration 20 --figures")
        output.document("init", {"written": [template], "kind": kind})
        return
    written = write_columns_template(file, kind=kind, sheet=sheet, force=force)
    output.say(*written.notes, f"wrote {written.file} for a table of kind {written.kind}")
    for name, guess in written.guesses.items():
        sign = ", sign reversed" if guess.sign < 0 else ""
        unit = f" in {guess.unit.unit}" if guess.unit and guess.unit.unit != "dimensionless" else ""
        check = f"; CHECK {', '.join(guess.doubts)}" if guess.doubts else ""
        output.say(f"  {name:<15} from '{guess.name}'{unit}{sign}{check}")
    advice = _to_check(written)
    output.say(*(f"please check: {line}" for line in advice))
    columns = {name: guess.name for name, guess in written.guesses.items()}
    content = {"written": [written.file], "kind": written.kind, "columns": columns}
    output.document("init", {**content, "to_check": advice, "notes": list(written.notes)})


def _to_check(written: "WrittenColumns") -> list[str]:
    """Return advice on what to check in the written `columns.toml`, as headers do not show it."""
    advice = ["the names, units and signs above; comments in columns.toml explain them"]
    if not written.guesses:
        advice = ["no column was recognised; map each by hand in columns.toml, which lists all "
                  "columns of the table at its end"]  # fmt: skip
    if written.doubts:
        advice = [f'values that end in "?" in columns.toml, {written.doubts}: correct each and '
                  'delete its "?"; until then no command reads the table']  # fmt: skip
    if written.kind == "rig":
        advice.append("angular speeds need radii in [constants], runs of one file a rule in [runs]")
    return advice
