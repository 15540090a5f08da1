# SPDX-License-Identifier: MIT
"""What every command and every option keeps, generated from the tree of commands.

A new command or option is covered as it is; an option of text with a form of its own needs an
example of what it refuses in `REFUSED_TEXTS`, if its metavar is no plain word of `FREE_TEXTS`.
"""

import inspect
import io
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args, get_origin

import pytest

from support.command_tree import LEAVES, ROOTS, TREE, Found, named
from zebro_lab.terminal import ending
from zebro_lab.terminal.request_command import value_types

FREE_TEXTS = {"TEXT", "NAME", "WORDS", "PHOTO", "PROFILE"}
"""Metavars of text that has no form, or is the name of something that is looked up."""
GROUPS_OF_LEGS = r"\{[1-6,]+\}(\s*<\s*\{[1-6,]+\})*"
REFUSED_TEXTS = {
    "PRIOR": ("friction 0.4", "friction = 0.4 ± 0", "friction ~ beta(1, 2)", "x ~ uniform(2, 1)"),
    "auto|peak|constant|E": ("2", "nan", "-inf", "steep"),
    "NAME|GROUPS": ("trot", "{1,2}", "{1,2,3}{4,5,6}", "{1,2,3} < {4,5,7}", "{}"),
    "INNER[,OUTER]": ("x", "nan", "1,2,3", ","),
    "LENGTH": ("5 kg", "wide", "nan m"),
    "ANGLE": ("5 kg", "wide", "nan deg", "0 deg", "90 deg"),
    "DICTIONARY:NUMBER:SIDE": ("4x4_50", "4x4_50:x:1cm", "4x4_50:0:1kg", "4x4_50:0:0mm"),
    "real|sim:WHAT": ("simulated", "sim:"),
    "X,Y[,DEG]": ("1", "1,2,3,4", "x,y", "nan,1", "0,0"),
    "U,V": ("1", "1,2,3", "x,y", "nan,1"),
    "U,V U,V U,V U,V": ("1,2", "1,2 3,4 5,6 x,y"),
    "LENGTHxWIDTH@HEIGHT": ("1", "1mx2kg@3m", "x@", "-1mmx2mm@3mm"),
    "PHOTO:NAME=U,V": ("photo", "photo:name=1", "photo:=1,2", "photo:name=nan,1"),
    "PHOTO:X,Y,YAW": ("photo:1,2", "1,2,3", "photo:1,2,nan"),
    "PHOTO,PHOTO,…": (",", "one,,two", "alone"),
    "BOARD": ("chess", "checkerboard:9x6", "checkerboard:9x6:25kg", "charuco:1"),
    "PROFILE@PORT|sim|replay:RUN": ("here", "@port", "profile@", "replay:"),
    "PROFILE@PORT": ("here", "@port", "profile@", "replay:run"),
    "INTERFACE:CHANNEL": ("socketcan", ":vcan0", "socketcan:"),
    "TIME": ("yesterday", "12:00"),
    "YYYY-MM-DDTHH:MM:SS": ("yesterday", "2020-06-01T12:00:00+01:00"),
    "KG,KG…": ("heavy", "1,nan", "1,-1", "0", ","),
    "A,B,C,D,E,F": ("a", "a,b,c,d,e,a", "a,b,c,d,e,"),
    "tcp://HOST:PORT": ("here", "127.0.0.1:8786", "http://here:1", "tcp://here:0"),
    "TARGET": ("1", "force@", "force@0", "force@0.1:-1", "walk:"),
    "TARGET[=WIDTH]": ("1", "friction=", "friction=0", "friction=x", "force@0=1"),
    "SLIP": ("coulomb:38", "coulomb:", "coulomb:nan", "coulomb:0.4:0", "coulomb:0.4:1:2"),
}
"""Texts that options of a metavar refuse."""


NEEDED_TOO = {
    "walk": {"--duration": "1", "--slip": "thesis"},
    "reach": {"--goal": "1,0", "--slip": "thesis"},
    "suggest": {"--target": "friction"},
    "annotate": {"--photo": "a.jpg", "--corners": "1,1 2,1 2,2 1,2"},
}
"""Options that are required by rules of a command, not of the parser."""
NO_DOCUMENT = {
    "zebro-lab camera clock": "it shows a picture on the terminal, and has no results",
}
"""Commands without `--json`, and why."""
NUMBER = r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"


def options(of: Any) -> list[Any]:
    """Return the options of a command that take a value."""
    return [p for p in of.params if p.param_type_name == "option" and not p.is_flag]


class Ended(NamedTuple):
    """How a command ended: exit code, and what it printed."""

    code: int
    out: str
    err: str


def run(found: Found, *arguments: str) -> Ended:
    """Run a command as its script does, in this process."""
    root, out, err = ROOTS[found.words[0]], io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
        ending.run(lambda: root.main([*found.words[1:], *arguments], prog_name=found.words[0]))
    return Ended(int(ended.value.code or 0), out.getvalue(), err.getvalue())


@pytest.mark.parametrize("found", TREE, ids=named)
def test_short_and_long_help_are_the_same_and_end_well(found):
    short, long = run(found, "-h"), run(found, "--help")
    assert (short.code, long.code) == (0, 0)
    assert short.out == long.out
    assert short.out.startswith(f"Usage: {named(found)} ")


HELP_OF_ALL = """
import sys
from contextlib import suppress
from support.command_tree import ROOTS, TREE
for found in TREE:
    with suppress(SystemExit):
        ROOTS[found.words[0]].main([*found.words[1:], "--help"], prog_name=found.words[0])
print("modules:", *sys.modules)
"""


def test_help_of_every_command_loads_nothing_heavy():
    done = subprocess.run(
        [sys.executable, "-c", HELP_OF_ALL], cwd=Path(__file__).parents[1],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    printed, _, modules = done.stdout.rpartition("modules:")
    assert printed.count("Usage: ") == len(TREE)
    assert not {
        "numpy", "scipy", "pandas", "numba", "matplotlib", "cv2", "PIL", "emcee", "pint",
        "pyarrow", "mcap", "serial", "rich.console",
    } & set(modules.split())  # fmt: skip


@pytest.mark.parametrize("found", TREE, ids=named)
def test_help_has_no_names_of_python_types_and_nothing_is_cut(found):
    text = re.sub(GROUPS_OF_LEGS, "", run(found, "-h").out)
    assert not re.search(r"<|>|\{|\}|(?<![,G])…|[^A-Z\]]\.\.\.", text), text
    assert "range" not in text.split("Options:")[1].split("Examples:")[0].replace("Range", "")
    for name, inner in getattr(found.command, "commands", {}).items():
        summary = " ".join(inner.get_short_help_str(10).split())
        assert summary
        assert f"{name} {summary}" in " ".join(text.split())


@pytest.mark.parametrize("found", TREE, ids=named)
def test_every_option_has_help_a_metavar_and_its_default_or_is_marked_required(found):
    for param in found.command.params:
        assert param.help, param.name
        is_flag = getattr(param, "is_flag", False)
        assert is_flag or re.fullmatch(r"[^<>{}]+", param.metavar or "")
        text = " ".join(run(found, "-h").out.split())
        if param.required:
            assert "[required]" in text[text.index(param.help.split("\n")[0][:20]) :]
        elif not is_flag and param.default not in (None, [], ()):
            assert "[default: " in text[text.index(param.help[:20]) :]


def kinds(found: Found, param: Any) -> tuple[Any, ...]:
    """Return the types of an option's values, from the annotation of the command's function."""
    parameters = inspect.signature(found.command.callback).parameters
    if param.name not in parameters:  # of Typer itself
        return ()
    return tuple(value_types(get_args(parameters[param.name].annotation)[0]))


def refused(param: Any, kind: Any) -> list[str]:
    """Return values that an option of a type must refuse, beyond its stated limits included."""
    if get_origin(kind) is Literal:
        return ["no-such-choice"]
    if kind not in (int, float) or param.metavar in REFUSED_TEXTS:
        return list(REFUSED_TEXTS.get(param.metavar, ()))
    said = param.help.partition("Allowed: ")[2]
    beyond = [
        (rf"{NUMBER} (?:or more|to )", lambda least: least - 1),
        (rf"(?:at most|to) {NUMBER}", lambda most: most + 1),
        (rf"(?:above|below) {NUMBER}", lambda limit: limit),
    ]
    outside = [act(float(each)) for form, act in beyond for each in re.findall(form, said)]
    texts = [f"{each:.0f}" if kind is int else f"{each!r}" for each in outside]
    return [*texts, "x", "1.5"] if kind is int else [*texts, "x", "nan", "inf", "-inf"]


VALUES = [
    (found, param, tuple(dict.fromkeys(text for kind in of for text in refused(param, kind))))
    for found in LEAVES
    for param in options(found.command)
    if (of := kinds(found, param))
]


@pytest.mark.parametrize(
    ("found", "param", "texts"), VALUES, ids=lambda each: getattr(each, "name", "")
)
def test_a_wrong_value_of_an_option_is_wrong_usage_and_names_the_option(
    found, param, texts, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    needed = [
        part
        for each in found.command.params
        if each.required and each is not param
        for part in ([] if each.param_type_name == "argument" else each.opts[:1]) + ["1"]
    ]
    for option, value in NEEDED_TOO.get(found.words[-1], {}).items():
        needed += [option, value] if option != param.opts[0] else []
    for text in texts:
        ended = run(found, param.opts[0], *[text] * param.nargs, *needed)
        assert ended.code == 2, (text, ended)
        assert param.opts[0] in ended.err
    assert not list(tmp_path.iterdir())


def test_wrong_values_are_derived_for_the_options_with_limits_choices_and_forms():
    names = {(named(found), param.name) for found, param, texts in VALUES if texts}
    for expected in (
        ("zebro-lab walk", "steering"), ("zebro-lab walk", "slip"),
        ("zebro-lab calibrate", "law"), ("calibrate-slip", "engine"),
        ("zebro-lab sim zebro", "drop"),
    ):  # fmt: skip
        assert expected in names
    (texts, *_) = (texts for _, param, texts in VALUES if param.name == "steering")
    assert {"0.0", "nan"} <= set(texts)


def test_text_of_a_form_has_examples_of_what_is_refused():
    unknown = {
        (named(found), param.opts[0], param.metavar)
        for found in LEAVES
        for param in options(found.command)
        if str in kinds(found, param)
        and param.metavar not in FREE_TEXTS
        and param.metavar not in REFUSED_TEXTS
    }
    assert not unknown


@pytest.mark.parametrize("found", LEAVES, ids=named)
def test_an_option_given_twice_is_wrong_usage_if_it_takes_one_value(found):
    for param in options(found.command):
        value = ["1"] * param.nargs
        ended = run(found, param.opts[0], *value, param.opts[0], *value)
        assert ended.code == 2 or param.multiple
        assert ("given twice" in ended.err) != param.multiple, param.name


def test_a_flag_and_its_opposite_are_given_twice():
    ended = run(Found(("zebro-lab",), None), "validate", "run", "--anchor", "--no-anchor")
    assert ended.code == 2
    assert "given twice" in ended.err


def test_every_command_with_results_prints_them_as_json_or_is_listed_with_its_reason():
    without = {
        named(found)
        for found in LEAVES
        if not {"--json", "--quiet"} <= {name for p in found.command.params for name in p.opts}
    }
    assert without == set(NO_DOCUMENT)
