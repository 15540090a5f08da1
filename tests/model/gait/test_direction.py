# SPDX-License-Identifier: MIT
import pytest

from model.errors import DomainError
from model.gait.direction import inner_legs
from model.robot import LEFT, RIGHT


def test_inner_legs_are_those_of_the_side_turned_to():
    assert set(inner_legs("left")) == set(LEFT)
    assert set(inner_legs("right")) == set(RIGHT)


def test_another_direction_is_an_error():
    with pytest.raises(DomainError, match="up"):
        inner_legs("up")
