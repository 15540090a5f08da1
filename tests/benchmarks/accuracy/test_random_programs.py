# SPDX-License-Identifier: MIT
import tomllib

import pytest

from benchmarks.accuracy.random_programs import random_program


def test_random_programs_turn_on_the_spot_curve_and_stand():
    for number in range(20):
        segments = tomllib.loads(random_program(number, 1).toml())["segment"]
        steering = [each.get("steering", 1.0) for each in segments]
        assert -1.0 in steering
        assert any(0 < each < 1 for each in steering)
        assert any("stand" in each for each in segments)


def test_a_share_is_of_the_steering_of_curves_alone():
    program = random_program(1, 1)
    right, wrong = (tomllib.loads(program.toml(share))["segment"] for share in (1.0, 0.95))
    for one, other in zip(right, wrong, strict=True):
        assert {**one, "steering": 0} == {**other, "steering": 0}
        if "steering" in one:
            assert 1 - other["steering"] == pytest.approx(0.95 * (1 - one["steering"]), abs=2e-4)
