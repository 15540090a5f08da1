# SPDX-License-Identifier: MIT
"""The mistakes of a program are named by segment and key."""

import numpy as np
import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.program_file import read_program

TRIPOD = '[[segment]]\ngait = "tripod"\n'


def written(folder, text):
    file = folder / "program.toml"
    file.write_text(text)
    return file


FAULTS = {
    "no segment": ("", r"expected one \[\[segment\]\] or more"),
    "no table": ("segment = 3", r"expected one \[\[segment\]\] or more"),
    "only stands": ("[[segment]]\nstand = 1", "only stands"),
    "unknown key": (TRIPOD + "until = { strides = 1 }\nspeed = 3", r"segment\[1\].speed"),
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
