# SPDX-License-Identifier: MIT
"""A program is walked from its file to the last leg angle, as fitted walks correct it."""

import json
from pathlib import Path

import numpy as np
import pytest

from model.walk_fit.prior import WrongLeg
from support.walk_posteriors import posterior_of, stored
from support.watchers import Impatient
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.folder import read_walk
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.program_stage import laid_out
from zebro_lab.walk.request import ModelRequest

pytestmark = pytest.mark.usefixtures("blank_pictures")

PROGRAM = """
[[segment]]
gait = "tripod"
until = { strides = 2 }

[[segment]]
stand = "500 ms"

[[segment]]
gait = "{1,4} < {2,5} < {3,6}"
cycle = 3.0
steering = -1
direction = "right"
until = { heading_deg = 45 }
"""


def written(folder, text):
    file = folder / "program.toml"
    file.write_text(text)
    return file


@pytest.fixture
def walk(run_command, tmp_path):
    """Return a function that walks the text of a program, and returns how that ended."""

    def ended(text, *options, slip="thesis", out="out"):
        more = ("--slip", slip, "--out", tmp_path / out, *options)
        return run_command("walk", written(tmp_path, text), *more)

    return ended


def test_a_program_is_walked_and_told_of_by_segment(walk, run_command, tmp_path, monkeypatch):
    windows, out = [], tmp_path / "out"
    monkeypatch.setattr(
        "zebro_lab.walk.pictures.draw_walk",
        lambda _folder, _walked, request: windows.append(request.window),
    )
    ended = walk(PROGRAM, "--figures", "--json")
    assert ended.code == 0, ended.err
    assert "the program, segment by segment" in ended.err
    assert "{1,4} < {2,5} < {3,6}, steering -1 right" in ended.err
    document = json.loads(ended.out)
    assert windows[0] == pytest.approx((0.0, document["duration_s"]))  # all of it
    assert document["speed_m_per_s"] is document["radius_m"] is None
    straight, stand, spot = document["segments"]
    assert straight["speed_m_per_s"] == pytest.approx(0.08, rel=0.1)
    assert stand["speed_m_per_s"] is None
    assert np.degrees(spot["turn_rad"]) == pytest.approx(-45, abs=0.5)
    assert max(document["unloaded_shares"]) < 0.5
    manifest, path = json.loads((out / "manifest.json").read_text()), read_walk(out)
    ends = [each["end"] for each in manifest["settings"]["segments"]]
    yaw = np.degrees(np.interp(ends, path.t, path.yaw))
    assert yaw[2] - yaw[1] == pytest.approx(-45, abs=0.5)
    assert str(tmp_path / "program.toml") in manifest["inputs"]
    again = tmp_path / "again"
    assert run_command("predict", out, "--slip", "thesis", "--out", again).code == 0
    np.testing.assert_allclose(path.position[-1], read_walk(again).position[-1], atol=2e-3)


def test_the_example_is_walked(run_command, tmp_path):
    example = Path(__file__).parents[3] / "examples" / "program.toml"
    assert run_command("walk", example, "--slip", "thesis", "--out", tmp_path / "out").code == 0
    end = read_walk(tmp_path / "out").position[-1, :2]
    assert np.hypot(*end) <= 0.2 + 1e-3  # back where it began


def test_a_missed_heading_is_told_of(walk, monkeypatch):
    monkeypatch.setattr("zebro_lab.walk.program_stage._MISSED", -1.0)
    ended = walk('[[segment]]\ngait = "tripod"\nsteering = -1\nuntil = { heading_deg = 75 }')
    assert ended.code == 0
    assert "WARNING: segment 1 turns by " in ended.out


def test_a_stop_request_ends_the_layout(tmp_path):
    with pytest.raises(WalkStopped):
        laid_out(written(tmp_path, PROGRAM), ModelRequest(slip="thesis"), RobotFile(), Impatient())


def test_a_program_of_too_many_steps_is_refused_before_it_is_laid_out(walk):
    ended = walk('[[segment]]\ngait = "tripod"\nuntil = { strides = 1000 }\n')
    assert ended.code == 1
    assert "the program would last 1002 s or more" in ended.err


def test_a_heading_is_found_with_what_fitted_walks_say(walk, tmp_path, calibration, legs):
    stored(calibration, legs, posterior_of(WrongLeg(2), steering=0.3))
    ended = walk(PROGRAM, "--json", slip=calibration)
    assert ended.code == 0, ended.err
    turn = json.loads(ended.out)["segments"][2]["turn_rad"]
    assert np.degrees(turn) == pytest.approx(-45, abs=0.6)


@pytest.mark.parametrize("option", [("--duration", 3), ("--cycle", 1.5), ("--gait", "tetrapod")])
def test_options_of_one_gait_do_not_go_with_a_program(walk, option):
    ended = walk(PROGRAM, *option)
    assert ended.code == 2
    assert f"'{option[0]}': is for one gait" in " ".join(ended.err.split())


def test_a_heading_is_found_by_the_model_with_slip_alone(walk):
    ended = walk(PROGRAM, "--model", "no-slip")
    assert ended.code == 2
    assert "--model: 'no-slip' does not find where a segment" in ended.err
    by_strides = PROGRAM.replace("heading_deg = 45", "strides = 2")
    assert walk(by_strides, "--model", "no-slip").code == 0
