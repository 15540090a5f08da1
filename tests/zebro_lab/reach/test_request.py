# SPDX-License-Identifier: MIT
"""Goals and times that cannot be meant are refused by name."""

import pytest
from typer import BadParameter

from zebro_lab.files.errors import SettingsError
from zebro_lab.reach.request import ReachRequest, SteppingRequest, parse_goal


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1", "is not X,Y"), ("1,2,3,4", "is not X,Y"), ("1;2", "is not X,Y"),
        ("nan,1", "is not X,Y"), ("0,0", "where the robot stands"), ("0,0,0", "where the robot"),
        ("1000,500", "at most 100 m"),
    ],
)  # fmt: skip
def test_a_goal_of_another_form_is_refused(text, said):
    with pytest.raises(BadParameter, match=said):
        parse_goal(text)
    with pytest.raises(BadParameter, match=said):
        ReachRequest(goal=(text,))


def test_one_time_of_two_is_refused():
    with pytest.raises(BadParameter, match="the other time"):
        SteppingRequest(tau_ground=1.0)
    with pytest.raises(BadParameter, match="give either"):
        SteppingRequest(tau_ground=1.0, tau_flight=1.0, cycle=2.0)


def test_a_step_that_is_too_long_is_refused():
    with pytest.raises(SettingsError, match="at most"):
        ReachRequest(goal=("1,0",), dt=0.1)
