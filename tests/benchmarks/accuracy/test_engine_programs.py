# SPDX-License-Identifier: MIT
import tomllib

import pytest

from benchmarks.accuracy import engine_programs
from benchmarks.accuracy.engine_programs import STEERING_ERROR, fails, random_program
from benchmarks.accuracy.rigid_engine.agreement import Agreement


def test_random_programs_turn_on_the_spot_curve_and_stand():
    for number in range(20):
        segments = tomllib.loads(random_program(number, 1).toml())["segment"]
        steering = [each.get("steering", 1.0) for each in segments]
        assert -1.0 in steering
        assert any(0 < each < 1 for each in steering)
        assert any("stand" in each for each in segments)


def test_a_planted_error_is_in_the_steering_of_curves_alone():
    program = random_program(1, 1)
    right, wrong = (tomllib.loads(program.toml(share))["segment"] for share in (1, STEERING_ERROR))
    for one, other in zip(right, wrong, strict=True):
        assert {**one, "steering": 0} == {**other, "steering": 0}
        if "steering" in one:
            assert other["steering"] == pytest.approx(0.95 * one["steering"], abs=1e-4)


def test_a_path_or_a_heading_too_far_off_fails():
    assert not fails(Agreement(0.01, 0.01, 1.0))
    assert fails(Agreement(0.016, 0.01, 1.0))
    assert fails(Agreement(0.01, 0.021, 1.0))


@pytest.mark.long
def test_a_program_is_walked_by_command_and_engine(rows):
    engine_programs.main(["--programs", "1", "--seed", "2"])
    ((number, _, _, _, path, heading, *_, wrong_path, _),) = rows()
    assert number == "1"
    assert float(path.split()[0]) < 1.5
    assert float(heading.split()[0]) < 2.0
    assert float(wrong_path.split()[0]) > 1.5
