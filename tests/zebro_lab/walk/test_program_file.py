# SPDX-License-Identifier: MIT
"""A program is walked from its file to the last leg angle, and its mistakes are named."""

import json
from pathlib import Path

import numpy as np
import pytest

from model.walk_fit.prior import WrongLeg
from support.walk_posteriors import posterior_of, stored
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.folder import read_walk
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.program_file import read_program
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


def test_a_program_is_walked_and_says_where_each_segment_ended(run_command, tmp_path):
    file, out = written(tmp_path, PROGRAM), tmp_path / "out"
    code, text, err = run_command("walk", file, "--slip", "thesis", "--out", out, "--figures")
    assert code == 0, err
    assert "the program, segment by segment" in text
    assert "{1,4} < {2,5} < {3,6}, steering -1 right" in text
    path = read_walk(out)
    manifest = json.loads((out / "manifest.json").read_text())
    segments = manifest["settings"]["segments"]
    ends = np.interp([each["end"] for each in segments], path.t, path.yaw)
    assert np.degrees(ends[2] - ends[1]) == pytest.approx(-45, abs=0.5)
    assert str(file) in manifest["inputs"]
    assert (out / "gantt.png").exists()
    ended = run_command("walk", file, "--slip", "thesis", "--out", out, "--json", "--quiet")
    document = json.loads(ended.out)
    assert [each["cycles"] for each in document["segments"]] == [
        each["cycles"] for each in segments
    ]


def test_the_walked_angles_are_predicted_to_the_same_path(run_command, tmp_path):
    file, out = written(tmp_path, PROGRAM), tmp_path / "walk"
    assert run_command("walk", file, "--slip", "thesis", "--out", out).code == 0
    again = tmp_path / "again"
    assert run_command("predict", out, "--slip", "thesis", "--out", again).code == 0
    first, second = read_walk(out), read_walk(again)
    np.testing.assert_allclose(first.position[-1], second.position[-1], atol=2e-3)


def test_the_example_is_walked(run_command, tmp_path):
    example = Path(__file__).parents[3] / "examples" / "program.toml"
    assert run_command("walk", example, "--slip", "thesis", "--out", tmp_path / "out").code == 0
    end = read_walk(tmp_path / "out").position[-1, :2]
    assert np.hypot(*end) <= 0.2 + 1e-3  # back where it began


def test_a_missed_heading_is_told_of(run_command, tmp_path, monkeypatch):
    monkeypatch.setattr("zebro_lab.walk.program_stage._MISSED", -1.0)
    text = '[[segment]]\ngait = "tripod"\nsteering = -1\nuntil = { heading_deg = 75 }'
    ended = run_command("walk", written(tmp_path, text), "--slip", "thesis", "--out",
                        tmp_path / "out")  # fmt: skip
    assert ended.code == 0
    assert "WARNING: segment 1 turns by " in ended.out


def test_a_program_is_told_of_by_segment_and_figures_show_all_of_it(
    run_command, tmp_path, monkeypatch
):
    windows = []
    monkeypatch.setattr(
        "zebro_lab.walk.pictures.draw_walk",
        lambda _folder, _walked, request: windows.append(request.window),
    )
    file, out = written(tmp_path, PROGRAM), tmp_path / "out"
    ended = run_command(
        "walk", file, "--slip", "thesis", "--out", out, "--figures", "--json", "--quiet"
    )
    document = json.loads(ended.out)
    assert document["speed_m_per_s"] is document["radius_m"] is None
    straight, stand, spot = document["segments"]
    assert straight["speed_m_per_s"] == pytest.approx(0.08, rel=0.1)
    assert stand["speed_m_per_s"] is None
    assert np.degrees(spot["turn_rad"]) == pytest.approx(-45, abs=0.5)
    assert max(document["unloaded_shares"]) < 0.5
    assert windows[0] == pytest.approx((0.0, document["duration_s"]))


def test_a_stop_request_ends_the_layout(tmp_path):
    class Stopping:
        def step(self, what, fraction):
            pass

        def stop_requested(self):
            return True

    with pytest.raises(WalkStopped):
        laid_out(written(tmp_path, PROGRAM), ModelRequest(slip="thesis"), RobotFile(), Stopping())


def test_a_program_of_too_many_steps_is_refused_before_it_is_laid_out(run_command, tmp_path):
    text = '[[segment]]\ngait = "tripod"\nuntil = { strides = 1000 }\n'
    ended = run_command("walk", written(tmp_path, text), "--slip", "thesis")
    assert ended.code == 1
    assert "the program would last 1002 s or more" in ended.err
    assert "--duration" not in ended.err


def test_a_heading_is_found_with_what_fitted_walks_say(run_command, tmp_path, calibration, legs):
    stored(calibration, legs, posterior_of(WrongLeg(2), steering=0.3))
    file, out = written(tmp_path, PROGRAM), tmp_path / "out"
    ended = run_command("walk", file, "--slip", calibration, "--out", out)
    assert ended.code == 0, ended.err
    path, manifest = read_walk(out), json.loads((out / "manifest.json").read_text())
    ends = [each["end"] for each in manifest["settings"]["segments"]]
    yaw = np.interp(ends, path.t, path.yaw)
    assert np.degrees(yaw[2] - yaw[1]) == pytest.approx(-45, abs=0.6)


FAULTS = {
    "no segment": ("", r"expected one \[\[segment\]\] or more"),
    "no table": ("segment = 3", r"expected one \[\[segment\]\] or more"),
    "only stands": ("[[segment]]\nstand = 1", "only stands"),
    "unknown key": (PROGRAM + "speed = 3", r"segment\[3\]"),
    "no gait": ("[[segment]]\nuntil = { strides = 1 }", r"segment\[1\].gait"),
    "unknown gait": (
        '[[segment]]\ngait = "trot"\nuntil = { strides = 1 }', "known names: 'tripod'",
    ),
    "no end": ('[[segment]]\ngait = "tripod"', r"segment\[1\].until.* expected one"),
    "two ends": (
        '[[segment]]\ngait = "tripod"\nuntil = { strides = 1, time = 3 }', "strides and time",
    ),
    "steering of the options": (
        '[[segment]]\ngait = "tripod"\nsteering = 1.3\nuntil = { strides = 1 }',
        "expected from -1, a turn on the spot, to 1, straight",
    ),
    "cycle and times": (
        '[[segment]]\ngait = "tripod"\ncycle = 2\nground_time = 1\nuntil = { strides = 1 }',
        r"segment\[1\].cycle.* give either",
    ),
    "heading to the other side": (
        '[[segment]]\ngait = "tripod"\nuntil = { heading_deg = -90 }', "the side to turn to is",
    ),
    "radians": (
        '[[segment]]\ngait = "tripod"\ntouchdown_deg = 0.87\nuntil = { strides = 1 }',
        "in radians, write 49.85",
    ),
    "endless stand": ("[[segment]]\nstand = 1e13", "stand: is 1e\\+13 s; expected at most 1000 s"),
    "no time": (
        '[[segment]]\ngait = "tripod"\ncycle = 1e-9\nuntil = { strides = 1 }', "expected 0.01 or",
    ),
    "half a turn on the ground": (
        '[[segment]]\ngait = "tripod"\ntouchdown_deg = -30\nuntil = { strides = 1 }',
        "by less than 180 degrees",
    ),
    "touchdown beyond the highest hip": (
        '[[segment]]\ngait = "tripod"\ntouchdown_deg = 91\nuntil = { strides = 1 }',
        "touchdown angle is 91.0 degrees",
    ),
    "near without a radius": (
        '[[segment]]\ngait = "tripod"\nuntil = { near = [1, 2] }', r"segment\[1\].until.near",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_a_mistake_in_a_program_is_named(text, message, tmp_path):
    with pytest.raises(SettingsError, match=message):
        read_program(written(tmp_path, text), leg_arc=np.pi)


def test_a_turn_by_time_alone_is_named_by_its_time(tmp_path):
    text = '[[segment]]\ngait = "tripod"\nturn_time = 0.1\nuntil = { strides = 1 }'
    assert read_program(written(tmp_path, text), leg_arc=np.pi).names == (
        "tripod, turn time 0.1 s left",
    )


def test_options_of_one_gait_do_not_go_with_a_program(run_command, tmp_path):
    file = written(tmp_path, PROGRAM)
    for option in (("--duration", 3), ("--cycle", 1.5), ("--gait", "tetrapod")):
        ended = run_command("walk", file, "--slip", "thesis", *option)
        assert ended.code == 2
        assert f"'{option[0]}': is for one gait; the program says it" in " ".join(ended.err.split())


def test_a_heading_is_found_by_the_model_with_slip_alone(run_command, tmp_path):
    ended = run_command("walk", written(tmp_path, PROGRAM), "--model", "no-slip")
    assert ended.code == 2
    assert "--model: 'no-slip' does not find where a segment" in ended.err
    by_strides = written(tmp_path, PROGRAM.replace("heading_deg = 45", "strides = 2"))
    out = tmp_path / "out"
    assert run_command("walk", by_strides, "--model", "no-slip", "--out", out).code == 0
