# SPDX-License-Identifier: MIT
"""`zebro-lab walk` and `predict` as their user meets them."""

import json
import subprocess

import pytest

from support.commands import COMMAND


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
    "rule of another model": ("walk", "--duration", "3", "--slip", "thesis", "--thesis", "text"),
    "negative step": ("walk", "--duration", "3", "--slip", "thesis", "--dt", "-1"),
}


@pytest.mark.parametrize("arguments", USAGE.values(), ids=USAGE)
def test_wrong_usage_is_exit_2(arguments, run_command):
    code, stdout, stderr = run_command(*arguments)
    assert (code, stdout) == (2, "")
    assert "Usage: " in stderr


def test_json_is_one_document_with_the_results_and_quiet_leaves_it_alone(run_command, tmp_path):
    given = ("walk", "--slip", "coulomb:0.4", "--duration", 4, "--json", "--out")
    ended, quiet = (run_command(*given, tmp_path / "a", *more) for more in ((), ("--quiet",)))
    document = json.loads(ended.out)
    assert ended.code == document["exit_code"] == quiet.code == 0
    assert document == json.loads(quiet.out)
    assert document["command"] == "walk"
    assert document["simulated"]
    assert document["duration_s"] == 4.0
    assert document["length_m"] > 0.1
    assert "SIMULATED walk" in ended.err
    assert quiet.err == ""


def test_quiet_prints_nothing_but_errors(run_command, tmp_path):
    given = ("walk", "--slip", "coulomb:0.4", "--duration", 1, "--quiet", "--out")
    assert run_command(*given, tmp_path / "a") == (0, "", "")
    ended = run_command(*given, tmp_path / "b", "--robot", "none.toml")
    assert (ended.code, ended.out) == (1, "")
    assert "none.toml: no such file" in ended.err
