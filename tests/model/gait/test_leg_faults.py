# SPDX-License-Identifier: MIT
"""Wrong signs, zeros and orders are suspected of every gait, and of none that is right."""

import numpy as np
import pytest

from model.gait.leg_faults import DirectionFault, SignFault, ZeroFault, leg_faults
from model.gait.leg_motion import leg_motion
from model.gait.leg_order import OrderFault
from support.leg_motions import T, gaits, tripod, virtual_world


def faults(theta: np.ndarray) -> list:
    motion = leg_motion(theta)
    return [] if motion is None else leg_faults(motion)


RIGHT = dict(gaits())
JUDGED = (
    "tripod, steering 1.0", "tripod, steering 1.3", "tetrapod", "wave, duty 0.75, lag 0.17",
    "backwards", "slow start", "there and back", "stand, walk, stand", "100 counts a turn", "8 Hz",
)  # fmt: skip


@pytest.mark.parametrize("name", RIGHT)
def test_nothing_is_suspected_of_a_right_walk(name):
    assert faults(RIGHT[name]) == []


@pytest.mark.reference
def test_nothing_is_suspected_of_walks_of_the_virtual_world(shared):
    assert [name for name, theta in virtual_world(shared) if faults(theta)] == []


@pytest.mark.parametrize("name", [name for name in JUDGED if name != "there and back"])
@pytest.mark.parametrize("legs", [(1,), (4,), (1, 3, 5), (2, 4, 6)])
def test_a_wrong_sign_is_found(name, legs):
    sign = np.where(np.isin(np.arange(1, 7), legs), -1, 1)
    found = faults(sign * RIGHT[name])
    if name == "backwards" and len(legs) == 3:  # forwards with the zero half a turn off, as likely
        assert [type(fault) for fault in found] in ([SignFault], [ZeroFault])
    else:
        assert found == [SignFault(legs)]


@pytest.mark.parametrize("zero_deg", [-90, 90, 180, 45, -60, 120])
@pytest.mark.parametrize("name", [name for name in JUDGED if name != "backwards"])
def test_a_wrong_zero_of_all_legs_is_found_and_its_repair_restores_the_stance(name, zero_deg):
    (found,) = faults(RIGHT[name] + np.radians(zero_deg))
    assert isinstance(found, ZeroFault)
    assert (found.legs, found.reversed) == ((1, 2, 3, 4, 5, 6), ())
    assert faults(RIGHT[name] + np.radians(zero_deg) + found.offset) == []
    error = np.degrees(found.offset) + zero_deg
    assert np.abs((error + 180) % 360 - 180).max() < 15


@pytest.mark.parametrize("zero_deg", [-90, 90, 180])
def test_a_wrong_zero_of_one_leg_is_found(zero_deg):
    theta = RIGHT["tripod, steering 1.3"].copy()
    theta[:, 4] += np.radians(zero_deg)
    (found,) = faults(theta)
    assert isinstance(found, ZeroFault)
    assert found.legs == (5,)


def test_all_signs_and_zeros_wrong_at_once_are_repaired_together():
    """The toe down is 0 and angles count backwards, as an encoder on the other face has them."""
    theta = np.pi / 2 - tripod().angles(T)
    (found,) = faults(theta)
    assert isinstance(found, ZeroFault)
    assert found.reversed == found.legs == (1, 2, 3, 4, 5, 6)
    assert faults(-theta + found.offset) == []


def test_a_mirrored_side_is_found_beside_a_wrong_order():
    columns = np.array((1, 3, 5, 2, 4, 6)) - 1
    theta = (tripod().angles(T) * [1, -1, 1, -1, 1, -1])[:, columns]
    sign, order = faults(theta)
    assert sign == SignFault((4, 5, 6))
    assert isinstance(order, OrderFault)
    assert (1, 3, 5, 2, 4, 6) in order.orders


def test_a_leg_that_turns_evenly_against_its_side_is_found():
    theta = 5 * T[:, None] * np.array([1, 1, -1, 1, 1, 1])
    assert faults(theta) == [DirectionFault((3,))]
