# SPDX-License-Identifier: MIT
"""Commands and groups of our own: what they add to Typer's. The whole tree is tested above."""

from importlib.metadata import version

import pytest
from typer.testing import CliRunner

from zebro_lab import main
from zebro_lab.files.provenance import software_commit

TYPOS = {
    "walkk": "walk", "predcit": "predict", "validat": "validate", "recrod": "record",
    "cmpare": "compare", "reprot": "report", "calibrat": "calibrate", "zebra": "zebro",
    "rig plann": "plan", "camera kitt": "kit", "walk --speedup": None,
    "walk --gaitt tripod": "--gait",
    "predict x --slipp thesis": "--slip", "record --zebor sim": "--zebro",
    "plot d --form png": "--format", "track x --camra c": "--camera", "export d --ou q": "--out",
    "xyzzy": None, "analyse": None, "walk --colour red": None, "rig fly": None,
    "calibrate-slip x --maxsteps 3": "--max-steps", "calibrate-slip x --chains 4": None,
}  # fmt: skip


@pytest.mark.parametrize("typed", TYPOS)
def test_the_right_spelling_is_offered_alone_or_none(run_command, typed):
    ended = run_command(*typed.split())
    assert ended.code == 2
    line = ended.err.splitlines()[-1]
    meant = TYPOS[typed]
    assert "No such " in line
    assert line.partition(" Did you mean ")[2] == ("" if meant is None else f"'{meant}'?")
    assert "Possible options" not in ended.err


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--duration", "2s", "found '2s'; expected a number"),
        ("--seed", "1.5", "found '1.5'; expected a whole number"),
        ("--gait", "tripot", "'--gait': 'tripot' is not a gait; did you mean 'tripod'?"),
    ],
)
def test_the_value_and_what_is_expected_are_named(run_command, option, value, message):
    ended = run_command("walk", "--slip", "thesis", option, value)
    assert ended.code == 2
    assert message in ended.err
    assert "Value error" not in ended.err


@pytest.mark.parametrize("program", [main.app, main.slip_app])
def test_version_is_that_of_package_and_commit(program):
    ended = CliRunner().invoke(program, ["--version"])
    assert ended.output == f"zebro-lab {version('zebro-lab')}, commit {software_commit()}\n"
