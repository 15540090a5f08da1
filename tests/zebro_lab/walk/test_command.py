# SPDX-License-Identifier: MIT
"""`zebro-lab walk` and `predict` as their user meets them."""

import json
import subprocess

import numpy as np
import pytest

from support.commands import COMMAND
from zebro_lab.walk.folder import read_walk_manifest


def test_walk_in_a_pipe_prints_gait_and_end_and_writes_its_folder(tmp_path):
    out = tmp_path / "out"
    process = subprocess.run(
        [COMMAND, "walk", "--steering", "1.3", "--slip", "thesis", "--duration", "6",
         "--out", str(out)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert process.returncode == 0, process.stderr
    assert "error" not in process.stderr
    assert "\x1b" not in process.stdout
    for part in (
        "SIMULATED walk: tripod, s = 1.3, left, model 'dynamics', slip thesis",
        "117.9909", "126.2247", "after 6 s at x ", "turning left, radius 1.1", "WARNING: ",
        "less than 2.13 N", str(out / "path.csv"),
    ):  # fmt: skip
        assert part in process.stdout
    assert json.loads((out / "manifest.json").read_text())["kind"] == "walk"


ERRORS = {
    "steering without solution": (("--steering", 9), "steering factor 9 has no solution"),
    "lift-off before touchdown": (("--liftoff-deg", 40), "lift off at 40 degrees"),
    "option of another gait": (("--tau-turn", 0.1), "--tau-turn: does not apply to gait 'trip"),
    "no such robot": (("--robot", "none.toml"), "none.toml: no such file"),
    "no slip law": (("--slip", "ice"), "--slip: 'ice' is not a file or folder"),
    "no friction": (("--slip", "coulomb:0"), "'coulomb:0' is no friction law"),
    "friction in percent": (("--slip", "coulomb:38"), "did you mean coulomb:0.38?"),
    "short time": (("--duration", 1e-5), "finite duration longer than one step"),
    "milliseconds as step": (("--dt", 1), "--dt: found 1 s; expected at most 0.005 s"),
}  # fmt: skip


@pytest.mark.parametrize(("options", "message"), ERRORS.values(), ids=ERRORS)
def test_error_is_one_line_and_nothing_is_written(options, message, run_command, tmp_path):
    out = tmp_path / "out"
    usual = {"--slip": "coulomb:0.4", "--duration": 2, "--out": out}
    given = usual | dict([options])
    code, stdout, stderr = run_command("walk", *(part for pair in given.items() for part in pair))
    of_an_option = stderr.startswith("error: --") and "is not a file" not in stderr
    assert (code, stdout) == (2 if of_an_option else 1, "")
    assert stderr.startswith("error: ")
    assert message in stderr
    assert stderr.count("\n") == 1
    assert not out.exists()


USAGE = {
    "no duration": ("walk", "--slip", "thesis"),
    "no slip law": ("walk", "--duration", "3"),
    "no such gait": ("walk", "--gait", "trot", "--duration", "3"),
    "no such model": ("predict", "legs.csv", "--model", "ours"),
    "no log": ("predict", "--slip", "thesis"),
    "window of nothing": ("walk", "--slip", "thesis", "--duration", "1", "--window", "0:1"),
    "rule of another model": ("walk", "--duration", "3", "--slip", "thesis", "--thesis", "text"),
    "negative step": ("walk", "--duration", "3", "--slip", "thesis", "--dt", "-1"),
}


@pytest.mark.parametrize("arguments", USAGE.values(), ids=USAGE)
def test_wrong_usage_is_exit_2(arguments, run_command):
    code, stdout, stderr = run_command(*arguments)
    assert (code, stdout) == (2, "")
    assert "Usage: " in stderr


def test_json_is_one_document_and_quiet_leaves_errors_alone(run_command, tmp_path):
    given = ("walk", "--slip", "coulomb:0.4", "--duration", 4, "--json", "--out")
    ended, quiet = (run_command(*given, tmp_path / "a", *more) for more in ((), ("--quiet",)))
    document = json.loads(ended.out)
    assert ended.code == document["exit_code"] == quiet.code == 0
    assert document == json.loads(quiet.out)
    assert (document["command"], document["simulated"]) == ("walk", True)
    assert document["duration_s"] == 4.0
    assert "SIMULATED walk" in ended.err
    assert quiet.err == ""
    ended = run_command(*given, tmp_path / "b", "--robot", "none.toml", "--quiet")
    assert (ended.code, ended.out) == (1, "")
    assert "none.toml: no such file" in ended.err


def test_predict_takes_what_walk_wrote(run_command, tmp_path):
    walk, robot = tmp_path / "walk", tmp_path / "robot.toml"
    robot.write_text("mass = 3.0\n[legs]\narc_deg = 200\n")
    asked = ("walk", "--slip", "coulomb:0.4", "--duration", 3, "--robot", robot, "--out", walk)
    assert run_command(*asked).code == 0
    out = tmp_path / "predicted"
    ended = run_command("predict", walk, "--model", "no-slip-simple", "--dt", "0.02", "--robot",
                        robot, "--direction", "right", "--out", out)  # fmt: skip
    assert (ended.code, ended.err) == (0, "")
    for part in ("logged leg angles, model 'no-slip-simple'", "straight ahead", "path.csv"):
        assert part in ended.out
    settings = read_walk_manifest(out)["settings"]
    assert (settings["model"], settings["dt"], settings["direction"]) == (
        "no-slip-simple", 0.02, "right",
    )  # fmt: skip
    assert settings["robot"]["mass"] == 3.0
    assert settings["robot"]["leg_arc"] == pytest.approx(np.radians(200))


def test_a_leg_log_with_a_gap_is_one_line_with_its_place(run_command, tmp_path):
    log = tmp_path / "legs.csv"
    rows = [f"{t / 100},{','.join([str(t / 50)] * 6)}" for t in (*range(30), *range(60, 90))]
    log.write_text("\n".join(["t,theta1,theta2,theta3,theta4,theta5,theta6", *rows]) + "\n")
    ended = run_command("predict", log, "--slip", "thesis", "--out", tmp_path / "out")
    assert ended.code == 1
    assert ended.err.startswith(f"error: {log}, column 't', row 31 (line 32): time jumps from 0.29")


@pytest.mark.parametrize(
    ("address", "problem"),
    [("here", "expected tcp://HOST:PORT"), ("tcp://8.8.8.8:8786", "outside of this machine")],
)
@pytest.mark.parametrize("name", ["predict none.csv", "walk --duration 2"])
def test_a_scheduler_that_cannot_be_used_is_told_before_anything_is_read(
    run_command, tmp_path, name, address, problem
):
    out = tmp_path / "out"
    ended = run_command(
        *name.split(), "--slip", "none.toml", "--draws", 2, "--out", out, "--scheduler", address
    )
    assert ended.code == 2
    assert "--scheduler" in ended.err
    assert problem in ended.err
    assert not out.exists()
