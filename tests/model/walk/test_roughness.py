# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError
from model.walk.ground import ground_at
from model.walk.roughness import CELLS_A_LENGTH, rough_ground

SD, LENGTH = 0.005, 0.05
ROUGH = rough_ground(SD, LENGTH, rng=np.random.default_rng(3))
FIELD = ROUGH.height[:-1, :-1]


def test_heights_have_the_standard_deviation_and_mean_zero():
    assert FIELD.std() == pytest.approx(SD, rel=0.05)  # of some ten thousand independent places
    assert abs(FIELD.mean()) < 0.05 * SD


@pytest.mark.parametrize("lengths", [0.5, 1.0, 2.0])
def test_heights_are_correlated_by_the_square_exponential(lengths):
    apart = round(lengths * CELLS_A_LENGTH)
    for axis in (0, 1):
        found = np.mean(FIELD * np.roll(FIELD, apart, axis=axis)) / SD**2
        assert found == pytest.approx(np.exp(-0.5 * lengths**2), abs=0.05)


def test_slopes_have_the_standard_deviation_over_the_correlation_length():
    slope = np.diff(FIELD, axis=0) / ROUGH.step
    assert slope.std() == pytest.approx(SD / LENGTH, rel=0.05)


def test_one_seed_is_one_ground_and_another_is_another():
    again, other = (
        rough_ground(SD, LENGTH, rng=np.random.default_rng(seed)).height for seed in (3, 4)
    )
    np.testing.assert_array_equal(ROUGH.height, again)
    assert np.abs(ROUGH.height - other).max() > SD


def test_the_ground_repeats_itself_without_an_edge():
    side = (len(ROUGH.height) - 1) * ROUGH.step
    for x, y in ((0.0, 0.3), (1.234, -0.01)):
        np.testing.assert_allclose(
            ground_at(ROUGH, x, y), ground_at(ROUGH, x + side, y - side), atol=1e-9
        )


@pytest.mark.parametrize(
    ("sd", "length", "message"),
    [
        (0.0, 0.05, "sd is 0 and correlation 0.05 m; expected both above zero"),
        (0.05, 0.05, "slopes of 1 .root mean square.; expected at most 0.5"),
    ],
)
def test_ground_that_is_none_or_too_steep_is_refused(sd, length, message):
    with pytest.raises(DomainError, match=message):
        rough_ground(sd, length, rng=np.random.default_rng(1))
