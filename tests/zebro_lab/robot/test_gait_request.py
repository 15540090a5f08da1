# SPDX-License-Identifier: MIT
"""Options of a gait."""

import pytest
from typer import BadParameter

from zebro_lab.robot.gait_argument import GAITS
from zebro_lab.robot.gait_request import GAIT_NAMES, GaitRequest, gait_name


def test_options_offer_the_gaits_that_there_are():
    assert set(GAIT_NAMES) == set(GAITS)
    with pytest.raises(BadParameter, match="'tripot' is not a gait; did you mean 'tripod'"):
        gait_name("tripot")


def test_a_turn_is_to_the_left_unless_a_side_is_given():
    assert GaitRequest().side == "left"
    assert GaitRequest(direction="right").side == "right"
    assert GaitRequest(direction="right", cycle=2.0).given() == {"direction": "right", "cycle": 2.0}
