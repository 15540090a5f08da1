# SPDX-License-Identifier: MIT
"""Ids and layouts of the CAN Simple protocol."""

import cantools
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.profile import shipped_file
from rig.slip_rig.can_simple import (
    AXIS_STATE,
    CONTROLLER_MODE,
    ERRORS,
    ESTIMATES,
    HEARTBEAT,
    INPUT_VELOCITY,
    TEMPERATURES,
    Command,
    can_id,
    describe_error,
    split_id,
)


@given(st.integers(0, 63), st.sampled_from(Command))
def test_an_id_splits_into_what_made_it(node, command):
    assert split_id(can_id(node, command)) == (node, command)
    assert can_id(node, command) <= 0x7FF


def test_the_shipped_dbc_agrees_with_the_layouts():
    text = shipped_file("odrive-cansimple.dbc").read_text()
    database = cantools.database.load_string(text, "dbc")

    def decode(command, data):
        return database.decode_message(int(command), data, decode_choices=False)

    assert decode(Command.HEARTBEAT, HEARTBEAT.pack(0x800, 8) + bytes(3)) == {
        "AxisError": 0x800,
        "AxisState": 8,
    }
    assert decode(Command.ENCODER_ESTIMATES, ESTIMATES.pack(-1.5, 0.25)) == {
        "Position": -1.5,
        "Velocity": 0.25,
    }
    assert decode(Command.SET_INPUT_VELOCITY, INPUT_VELOCITY.pack(2.5, 0.0)) == {
        "InputVelocity": 2.5,
        "TorqueFeedForward": 0.0,
    }
    assert decode(Command.SET_AXIS_STATE, AXIS_STATE.pack(8)) == {"RequestedState": 8}
    assert decode(Command.SET_CONTROLLER_MODE, CONTROLLER_MODE.pack(2, 1)) == {
        "ControlMode": 2,
        "InputMode": 1,
    }
    assert decode(Command.TEMPERATURE, TEMPERATURES.pack(41.5, 30.25)) == {
        "TransistorTemperature": 41.5,
        "MotorTemperature": 30.25,
    }


@pytest.mark.parametrize("firmware", ERRORS)
def test_every_bit_of_an_axis_error_is_described_and_unknown_ones_by_their_number(firmware):
    assert describe_error(0, firmware) == ""
    known = sum(ERRORS[firmware])
    assert describe_error(known, firmware).split(", ") == list(ERRORS[firmware].values())
    assert describe_error(0x800 | 0x10000000, firmware).split(", ") == [
        ERRORS[firmware][0x800],
        "unknown error 0x10000000",
    ]
