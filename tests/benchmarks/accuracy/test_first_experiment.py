# SPDX-License-Identifier: MIT
import json
import tomllib

import pytest
import tomlkit

from benchmarks.accuracy import first_experiment
from benchmarks.accuracy.calibrated_experiments import NAMES
from benchmarks.accuracy.first_experiment import (
    PLAN,
    SLIPS,
    TRUTHS,
    advised_plan,
    measure,
    read_found,
)
from model.slip.thesis import THESIS_VALUES

EVEN = PLAN.replace("SLIPS", SLIPS["even"])
TRUTH = dict(zip(NAMES, THESIS_VALUES, strict=True))

ADVICE = """slips are missing. In a copy of the plan, set these:
[points]
loads = [5]
slips = [0.01, 0.05]
duration = 0.2
[controls]
tare_every = 2
Run the copy into another folder"""


def write_fit(out, *, stiffness=TRUTH["slip_stiffness"], steps=()):
    """Write what a fit found; the fit itself takes too long here."""
    ends = {"slip_stiffness": stiffness, "friction": TRUTH["friction"]}
    out.mkdir()
    (out / "slip.toml").write_text(
        tomlkit.dumps(
            {
                "parameters": {n: {"q05": 0.99 * x, "q95": 1.01 * x} for n, x in ends.items()},
                "verdict": {
                    "trustworthy": not steps,
                    "headline": "told",
                    "next_steps": list(steps),
                },
            }
        ),
        encoding="utf-8",
    )


def test_advised_lines_replace_those_of_the_plan_and_leave_the_others():
    plan = tomllib.loads(advised_plan(EVEN, ("look at a picture", ADVICE)))
    assert plan["points"]["slips"] == [0.01, 0.05]
    assert plan["points"]["omega_leg"] == 12.0
    assert plan["controls"] == {"tare_every": 2}
    assert plan["limits"] == tomllib.loads(EVEN)["limits"]


def test_advice_without_lines_of_a_plan_gives_none():
    assert advised_plan(EVEN, ("sample longer", "look at residuals.png [the first]")) is None


@pytest.mark.parametrize(("stiffness", "held"), [(1.005, True), (1.03, False)])
def test_an_interval_holds_the_truth_or_does_not(tmp_path, stiffness, held):
    write_fit(tmp_path / "out", stiffness=stiffness * TRUTH["slip_stiffness"])
    found = read_found(tmp_path / "out", THESIS_VALUES)
    assert found.covered == (held, True)


def test_a_rig_of_another_curve_is_measured_by_the_function_of_the_command(tmp_path):
    short = PLAN.replace("SLIPS", "[0.9]").replace("[5.0, 10.0]", "[5.0]")
    measure(
        short.replace("duration = 1.0", "duration = 0.2"), 3, tmp_path / "data", TRUTHS["steep"]
    )
    (run,) = (tmp_path / "data").glob("*/run.json")
    assert json.loads(run.read_text())["truth"]["rig"]["values"] == list(TRUTHS["steep"])


def test_both_experiments_are_measured_and_the_second_fit_has_both(monkeypatch, tmp_path, rows):
    short = PLAN.replace("duration = 1.0", "duration = 0.2")
    monkeypatch.setattr(first_experiment, "PLAN", short.replace("[5.0, 10.0]", "[5.0]"))
    command, fitted = first_experiment.run, []

    def run(name, *words):
        if name.name != "calibrate-slip":
            return command(name, *words)
        *data, _, out = words
        fitted.append([len([*folder.glob("*/log.mcap")]) for folder in data])
        before = len(data) == 1
        write_fit(out, stiffness=20.0 if before else 20.4, steps=(ADVICE,) if before else ())
        return 0

    monkeypatch.setattr(first_experiment, "run", run)
    first_experiment.main(1, 7, THESIS_VALUES, "[0.0, 1.0]")
    assert fitted == [[2], [2, 2]]
    assert rows() == [["7", "NO", "yes", "told", "yes", "yes", "told"]]
