# SPDX-License-Identifier: MIT
"""`zebro-lab rig run --adaptive` on a simulated rig, as a person gives it."""

import json

import pytest

from rig.experiment.run import Outcome
from support.experiment_plans import THESIS_PLAN, short_plan
from zebro_lab.adaptive import stage
from zebro_lab.adaptive.rounds import Round, write_rounds
from zebro_lab.calibration.stage import Stopped

PILOT = {
    "loads = [2.13, 6.63, 8.13, 12.75]": "loads = [2.13, 12.75]",
    "slips = { first = 0.0, last = 1.0, count = 62 }":
        "slips = [0.0, 0.02, 0.08, 0.18, 0.33, 0.51, 0.73, 1.0]",
    "duration = 1.0": "duration = 0.5",
    "check_every = 62": "check_every = 0",
}  # fmt: skip


@pytest.mark.long
def test_a_simulated_rig_is_measured_until_its_stiffness_is_known(run_command, tmp_path):
    text = THESIS_PLAN.read_text()
    for old, new in PILOT.items():
        assert old in text
        text = text.replace(old, new)
    (plan := tmp_path / "plan.toml").write_text(text)
    data = tmp_path / "data"
    words = ("rig", "run", plan, "--rig", "sim", "--fast", "--data", data, "--adaptive",
             "slip_stiffness=0.6", "--budget", "900", "--json")  # fmt: skip
    ended = run_command(*words)
    assert ended.code == 0, ended.err
    document = json.loads(ended.out)
    widths = [each["half_widths"]["slip_stiffness"] for each in document["rounds"]]
    assert widths[-1] <= 0.6 < widths[0]
    assert document["reached"]
    assert document["simulated"]
    assert sum(each["seconds"] for each in document["rounds"]) <= 900
    assert run_command(*words).code == 1  # nothing is measured twice
    assert json.loads(run_command(*words, "--resume").out)["rounds"] == document["rounds"]
    fitted = run_command("calibrate", data, "--engine", "laplace", "--out", tmp_path / "all")
    assert fitted.code == 0, fitted.err
    assert "verdict: converged and trustworthy as far as tested" in fitted.out
    points = sum(each["points"] for each in document["rounds"])
    assert f"{points} runs" in fitted.out


@pytest.mark.parametrize("begun", [True, False])
def test_a_stop_while_a_round_is_fitted_says_how_to_go_on(
    run_command, monkeypatch, tmp_path, begun
):
    def adapt(request, **_):
        if begun:
            write_rounds(request.data, {}, ())
        raise Stopped(None)

    monkeypatch.setattr(stage, "adapt", adapt)
    data = tmp_path / "data"
    data.mkdir()
    ended = run_command("rig", "run", short_plan(tmp_path), "--rig", "sim", "--adaptive",
                        "friction=0.01", "--data", data)  # fmt: skip
    assert ended.code == 1
    assert ("--resume goes on" in ended.out) == begun
    assert "stopped before sampling began" in ended.err


def ending(monkeypatch, *, reached, stopped=None):
    outcome = Outcome("completed" if stopped is None else "safe stop: asked for", 2, (), 2, "sim:x")
    rounds = (Round(1, 115.0, 16, 0, {"friction": 0.02}),)
    found = stage.Adapted(rounds, reached, "the budget is spent", outcome, stopped)
    monkeypatch.setattr(stage, "adapt", lambda *_, **__: found)


@pytest.mark.parametrize(("reached", "code"), [(True, 0), (False, 3)])
def test_the_exit_code_says_whether_the_interval_was_reached(
    run_command, monkeypatch, tmp_path, reached, code
):
    ending(monkeypatch, reached=reached)
    ended = run_command("rig", "run", short_plan(tmp_path), "--rig", "sim", "--adaptive",
                        "friction=0.01", "--data", tmp_path / "data")  # fmt: skip
    assert ended.code == code
    assert "± 0.02" in ended.out
    assert ("wider than asked" in ended.out) != reached


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--adaptive", "frction=0.1"), "did you mean 'friction'"),
        (("--adaptive", "friction=x"), "expected a number above 0"),
        (("--budget", "100"), "--adaptive"),
    ],
)
def test_mistakes_are_said_before_anything_moves(run_command, tmp_path, words, said):
    ended = run_command(
        "rig",
        "run",
        short_plan(tmp_path),
        "--rig",
        "sim",
        "--fast",
        "--data",
        tmp_path / "d",
        *words,
    )
    assert ended.code in (1, 2)
    assert said in ended.err
    assert not (tmp_path / "d").exists()
