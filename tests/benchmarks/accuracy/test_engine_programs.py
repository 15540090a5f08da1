# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy import engine_programs
from benchmarks.accuracy.engine_programs import fails, replayed, steered_wrongly
from benchmarks.accuracy.random_programs import Program, Segment
from benchmarks.accuracy.rigid_engine.agreement import Agreement
from model.gait import TRIPOD
from model.gait.program import ProgramLegs, cycle_gait


def test_cycles_again_of_the_same_gaits_are_the_same_and_of_others_as_long():
    one, spot, less = (
        cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0, steering=steering)
        for steering in (1.0, -1.0, -0.9)
    )
    legs = ProgramLegs.beginning_with(one).with_cycle(one).with_stand(0.4).with_cycle(spot)
    legs = legs.stopped_at(legs.end - 0.7).with_stand(0.2)
    same, other = (
        replayed(legs, [(one, one), (spot, spot)]),
        replayed(legs, [(one, one), (spot, less)]),
    )
    t = np.linspace(0.0, legs.end, 300)
    np.testing.assert_allclose(same.reference().angles(t), legs.reference().angles(t), atol=1e-9)
    assert other.end == pytest.approx(legs.end)
    apart = np.abs(other.reference().angles(t) - legs.reference().angles(t)).max()
    assert np.radians(2.0) < apart < np.radians(5.0)


def test_a_planted_error_turns_the_robot_less_though_the_right_program_meets_its_heading(tmp_path):
    keys = 'gait = "tripod"\ncycle = 1.2\nuntil = { heading_deg = 40 }'
    program = Program(1, (Segment(keys, -1.0),), 0.38)
    legs = steered_wrongly(program, tmp_path)
    motion = engine_programs.motion_by_model(0.38, legs.reference(), legs.end, engine_programs.FINE)
    assert 0.93 < np.degrees(motion.yaw[-1]) / 40.0 < 0.97


def test_a_path_or_a_heading_too_far_off_fails():
    assert not fails(Agreement(0.01, 0.01, 1.0))
    assert fails(Agreement(0.016, 0.01, 1.0))
    assert fails(Agreement(0.01, 0.021, 1.0))


@pytest.mark.long
def test_a_program_is_walked_by_command_and_engine(rows):
    engine_programs.main(["--programs", "1", "--seed", "2"])
    ((number, _, _, _, path, heading, _, finer, _, _, wrong_heading),) = rows()
    assert number == "1"
    assert float(path.split()[0]) < 1.5
    assert float(heading.split()[0]) < 2.0
    assert float(finer.split()[0]) < 1.0
    assert float(wrong_heading.split()[0]) > 2.0
