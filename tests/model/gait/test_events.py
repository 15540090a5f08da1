# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError
from model.gait.direction import inner_legs
from model.gait.events import scheduled_reference
from model.gait.maxplus import cyclicity
from model.gait.notation import TRIPOD, Gait
from model.gait.scheduler import straight_system
from model.gait.steering import TripodAngles, tripod_reference
from model.gait.turning import turning_system
from model.robot import LEFT

DOWN, UP = 0.8, 2.2


def turn(gait=TRIPOD, *, flight=0.8, ground=0.8, by=0.1, stance=0.05):
    return turning_system(
        gait,
        inner=inner_legs("left"),
        ground_time=ground,
        flight_time=flight,
        turn_time=by,
        double_stance=stance,
    )


def test_straight_tripod_schedule_is_the_straight_tripod():
    system = straight_system(TRIPOD, ground_time=1.0, flight_time=1.0)
    scheduled = scheduled_reference(system, DOWN, liftoff=UP)
    tripod = tripod_reference(TripodAngles(DOWN, UP, DOWN, UP), 2.0)
    t = np.linspace(0.0, 5.0, 300)
    np.testing.assert_allclose(scheduled.angles(t), tripod.angles(t), atol=1e-9)


def test_double_stance_lasts_as_long_as_asked():
    system = straight_system(TRIPOD, ground_time=0.1, flight_time=1.0, double_stance=0.2)
    legs = scheduled_reference(system, DOWN, liftoff=UP)
    stands = legs.stance_intervals((0.0, 12 * legs.period))
    lift = stands[0][:, 1]
    lift = lift[(lift > legs.period) & (lift < 11 * legs.period)]
    gaps = [t - stands[1][stands[1][:, 0] <= t, 0].max() for t in lift]
    np.testing.assert_allclose(gaps, 0.2)


def test_liftoff_before_touchdown_is_refused():
    with pytest.raises(DomainError, match="leg 1 touches down"):
        scheduled_reference(turn(), UP, liftoff=DOWN)


def powers_by_hand(matrix, n):
    """Return the first n max-plus powers of a matrix, entry by entry, without our algebra."""
    size, found = len(matrix), [matrix.tolist()]
    for _ in range(n - 1):
        last = found[-1]
        found.append([
            [max(matrix[i][k] + last[k][j] for k in range(size)) for j in range(size)]
            for i in range(size)
        ])  # fmt: skip
    return np.array(found)


@pytest.mark.parametrize("seed", range(20))
def test_cycle_and_coupling_time_of_random_gaits_are_those_of_the_powers(seed):
    rng = np.random.default_rng(seed)
    legs, cuts = (
        rng.permutation(6) + 1,
        np.sort(rng.choice(np.arange(1, 6), rng.integers(0, 6), False)),
    )
    gait = Gait(tuple(tuple(group.tolist()) for group in np.split(legs, cuts)))
    ground, flight, turn, double = rng.integers(1, 30, 4) / 16
    system = turning_system(
        gait, inner=LEFT, ground_time=ground, flight_time=flight, turn_time=turn,
        double_stance=double,
    )  # fmt: skip
    powers = powers_by_hand(system.matrix, 40)
    with np.errstate(invalid="ignore"):
        growth = (powers[-1] - powers[-13]) / 12
    assert system.cycle_time == pytest.approx(growth[np.isfinite(growth)].mean(), abs=1e-9)
    settled = powers - system.cycle_time * np.arange(1, 41)[:, None, None]
    pairs = [(k, other) for other in range(1, 40) for k in range(other)
             if np.allclose(settled[k], settled[other], atol=1e-9)]  # fmt: skip
    first, again = min(pairs, key=lambda pair: pair[1])
    assert system.coupling_time == first + 1
    assert cyclicity(system.matrix) == again - first
