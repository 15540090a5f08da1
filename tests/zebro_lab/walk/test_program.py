# SPDX-License-Identifier: MIT
"""A program is walked from its file to the last leg angle, and its mistakes are named."""

import json
from pathlib import Path

import numpy as np
import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.folder import read_walk
from zebro_lab.walk.program_file import read_program

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


def test_a_heading_that_standing_legs_overshoot_is_told_of(run_command, tmp_path):
    text = '[[segment]]\ngait = "tripod"\nsteering = -1\nuntil = { heading_deg = 75 }'
    ended = run_command("walk", written(tmp_path, text), "--slip", "thesis", "--out",
                        tmp_path / "out")  # fmt: skip
    assert ended.code == 0
    assert "WARNING: segment 1 turns by +10" in ended.out


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
    "near without a radius": (
        '[[segment]]\ngait = "tripod"\nuntil = { near = [1, 2] }', r"segment\[1\].until.near",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_a_mistake_in_a_program_is_named(text, message, tmp_path):
    with pytest.raises(SettingsError, match=message):
        read_program(written(tmp_path, text), leg_arc=np.pi)


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
