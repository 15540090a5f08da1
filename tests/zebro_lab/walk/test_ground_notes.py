# SPDX-License-Identifier: MIT
"""Walks on other ground, by the commands."""

import hashlib
import json

import numpy as np
import pytest

from model.robot import Robot
from zebro_lab.walk.folder import read_draws, read_walk

GAIT = ("--steering", 1.0, "--slip", "coulomb:0.38", "--dt", 0.004)
GROUND = """
slope_deg = [4, 0]
heights = { file = "h.csv", step = 0.05, origin = [-0.5, -1] }
"""
SMALL_MAP = """
heights = "h.csv"
step = 0.1
origin = [-0.2, -0.2]
"""
PROGRAM = """
[[segment]]
gait = "tripod"
until = { near = [0.2, 0, 0.05] }
"""


@pytest.fixture
def ground(tmp_path):
    """Return a function that writes a ground.toml."""

    def write(text):
        file = tmp_path / "ground.toml"
        file.write_text(text)
        return file

    return write


def test_a_walk_up_a_slope_and_a_step_says_so(run_command, ground, tmp_path):
    file, out = ground(GROUND), tmp_path / "out"
    step = np.where(np.arange(61) > 12, 0.005, 0.0)  # 5 mm higher from x = 0.15 m on
    np.savetxt(tmp_path / "h.csv", np.tile(step, (41, 1)), delimiter=",")
    code, text, error = run_command("walk", *GAIT, "--duration", 5, "--ground", file, "--out", out)
    assert code == 0, error
    for part in ("on ground.toml", "slope of 4 deg along x", "heights of h.csv"):
        assert part in text
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["inputs"][str(file)] == hashlib.sha256(file.read_bytes()).hexdigest()
    assert manifest["settings"]["ground"]["slope_deg"] == [4.0, 0.0]
    path = read_walk(out)
    climbed = np.tan(np.radians(4)) * path.position[-1, 0] + 0.005
    raised = path.position[-1, 2] - path.position[0, 2]
    assert raised == pytest.approx(climbed, abs=0.012)
    code, predicted, error = run_command(
        "predict", out, "--slip", "coulomb:0.38", "--dt", 0.004, "--ground", file, "--draws", 3,
        "--out", tmp_path / "again",
    )  # fmt: skip
    assert code == 0, error
    assert "heights of h.csv" in predicted
    again = read_walk(tmp_path / "again")
    np.testing.assert_allclose(again.position[-1], path.position[-1], atol=0.01)
    draws = read_draws(tmp_path / "again")
    assert np.abs(draws.position[:, -1] - path.position[-1, :2]).max() < 0.1


def test_a_robot_that_walks_off_its_map_is_told_when(run_command, ground, tmp_path):
    (tmp_path / "h.csv").write_text("0,0,0,0,0\n" * 5)
    code, text, error = run_command(
        "walk", *GAIT, "--duration", 4, "--ground", ground(SMALL_MAP), "--out", tmp_path / "out"
    )
    assert code == 0, error
    assert "WARNING: the robot is off the map of heights in" in text
    hip = Robot().hips[:, 0].max()
    path = read_walk(tmp_path / "out")
    left = path.t[(path.position[:, 0] + hip > 0.2).argmax()]
    assert f"first {left:.2f} s after the start" in text.replace("\n", " ")


def test_a_program_finds_its_places_on_the_ground(run_command, ground, tmp_path):
    program = tmp_path / "program.toml"
    program.write_text(PROGRAM)
    uphill = ground("slope_deg = [8, 0]\n")
    code, text, error = run_command(
        "walk", program, "--slip", "coulomb:0.38", "--ground", uphill, "--out", tmp_path / "out"
    )
    assert code == 0, error
    assert "slope of 8 deg" in text
    assert read_walk(tmp_path / "out").position[-1, 0] == pytest.approx(0.2, abs=0.05)


@pytest.mark.parametrize("model", ["thesis", "no-slip", "no-slip-simple"])
def test_models_of_level_ground_refuse_another(run_command, ground, tmp_path, model):
    code, _, error = run_command(
        "walk", "--slip", "thesis", "--model", model, "--duration", 1,
        "--ground", ground("slope_deg = [1, 0]"), "--out", tmp_path / "out",
    )  # fmt: skip
    assert code in (1, 2)
    assert f"the model '{model}' walks on level ground only" in error
    assert not (tmp_path / "out").exists()


def test_the_ground_itself_is_not_written_over(run_command, ground, tmp_path):
    file = ground("slope_deg = [1, 0]")
    code, _, _ = run_command("walk", *GAIT, "--duration", 1, "--ground", file, "--out", file)
    assert code != 0
    assert file.read_text() == "slope_deg = [1, 0]"
