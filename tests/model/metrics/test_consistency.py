# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import InsufficientData
from model.metrics.consistency import STATISTICS, consistency, nees

N = 12
NOISE = np.array([0.002, 0.002, 0.01])  # standard deviations of the tracker's noise


def paths(n, *, spread=0.02, seed=1):
    """Return straight walks along x whose distance and heading errors grow with time."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.1, 1.0, N)
    scale, turn = rng.standard_normal((2, n, 1)) * spread
    return np.stack([(1 + scale) * t, turn * t, turn * t], axis=-1)


def track(seed, **options):
    rng = np.random.default_rng(seed)
    return paths(1, seed=seed, **options)[0] + NOISE * rng.standard_normal((N, 3))


def judged(observed):
    noise = NOISE * np.random.default_rng(2).standard_normal((400, N, 3))
    return consistency(paths(400) + noise, observed)


def test_tracks_of_the_ensemble_s_own_kind_are_plausible_as_often_as_claimed():
    held = [[each.consistent for each in judged(track(seed))] for seed in range(100, 180)]
    assert np.mean(held) == pytest.approx(0.95, abs=0.04)


def test_a_track_off_by_several_spreads_is_not():
    far = judged(track(7) + np.array([0.0, 0.2, 0.0]))
    by_name = {each.name: each for each in far}
    assert tuple(by_name) == STATISTICS
    assert not by_name["nees"].consistent
    assert by_name["nees"].p_value < 0.02


def test_nees_of_the_draws_themselves_is_about_one():
    draws = paths(2000) + np.random.default_rng(3).normal(0, 0.01, (2000, N, 3))
    assert nees(draws, draws).mean() == pytest.approx(1.0, abs=0.01)


def test_a_track_without_headings_is_judged_by_its_places():
    observed = track(5)
    observed[:, 2] = np.nan
    assert [each.name for each in judged(observed)] == ["nees", "along", "cross"]


def test_few_draws_are_no_band():
    with pytest.raises(InsufficientData, match="draw 50"):
        consistency(paths(10), track(1))
