# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import InsufficientData
from model.slip.curve_band import CurveBand, farthest, simultaneous_band


def drawn(n, *, seed=0):
    """Straight lines with a random slope and offset, at two loads and 30 slips."""
    rng, slip = np.random.default_rng(seed), np.linspace(0.01, 1, 30)
    slope, offset = rng.normal(5.0, 1.0, (n, 2, 1)), rng.normal(0.0, 0.5, (n, 2, 1))
    return offset + slope * slip


def test_the_share_of_new_curves_inside_everywhere_is_the_band_s():
    band = simultaneous_band(drawn(4000), level=0.9)
    inside = [farthest(band, each).inside for each in drawn(2000, seed=1)]
    assert np.mean(inside) == pytest.approx(0.9, abs=0.02)


def test_the_farthest_point_is_named_with_its_side_and_unknown_points_do_not_count():
    band = CurveBand(np.zeros((2, 3)), np.ones((2, 3)), 2.0)
    force = np.array([[0.0, 1.0, np.nan], [-3.0, 0.5, 1.9]])
    place = farthest(band, force)
    assert (place.load, place.slip, place.inside) == (1, 0, False)
    assert (place.ratio, place.difference, place.outside) == (1.5, -3.0, 0.2)
    assert farthest(band, np.where(force == -3.0, np.nan, force)).inside


def test_a_band_of_few_draws_and_a_curve_that_is_known_nowhere_are_refused():
    with pytest.raises(InsufficientData, match="a calibration that has an uncertainty"):
        simultaneous_band(drawn(1))
    with pytest.raises(InsufficientData, match="known at no slip ratio"):
        farthest(simultaneous_band(drawn(50)), np.full((2, 30), np.nan))
