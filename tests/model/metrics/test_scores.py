# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.metrics.consistency import consistency
from model.metrics.scores import (
    LEVELS,
    coverage_range,
    crps,
    energy_score,
    ensemble_scores,
    interval_coverage,
)

TIMES = np.arange(2.0, 31.0, 2.0)
TRACKER = np.array([2e-3, 2e-3, 5e-3])  # standard deviations of its noise


def tracked(poses, rng):
    """Add the tracker's noise."""
    return poses + TRACKER * rng.standard_normal(poses.shape)


def paths(m: int, rng: np.random.Generator, *, speed=1.0, heading=0.0, spread=1.0):
    """Return m arcs with an uncertain speed, curvature and start, shape (m, times, 3)."""
    v = 0.085 * speed * (1 + 0.01 * spread * rng.standard_normal((m, 1)))
    rate = 0.05 + 0.002 * spread * rng.standard_normal((m, 1))
    start = spread * rng.standard_normal((m, 3)) * [0.002, 0.002, 0.01] + [0, 0, heading]
    yaw = start[:, 2:] + rate * TIMES
    x = start[:, :1] + v / rate * (np.sin(yaw) - np.sin(start[:, 2:]))
    y = start[:, 1:2] - v / rate * (np.cos(yaw) - np.cos(start[:, 2:]))
    return np.stack([x, y, yaw], axis=-1)


def rejected(truths, *, spread=1.0):
    """Return the names of the statistics that reject each truth."""
    rng = np.random.default_rng(8)
    draws = tracked(paths(400, rng, spread=spread), rng)
    return [
        {each.name for each in consistency(draws, one) if not each.consistent}
        for one in tracked(truths, rng)
    ]


def test_a_perfect_ensemble_covers_at_its_levels():
    rng = np.random.default_rng(6)
    draws = tracked(paths(1000, rng), rng)
    truths = tracked(paths(300, rng), rng)
    coverage = np.mean([interval_coverage(draws, one, LEVELS)[0] for one in truths], axis=0)
    np.testing.assert_allclose(coverage, np.array([[0.5], [0.9], [0.95]]) * np.ones(3), atol=0.05)


@pytest.mark.parametrize(("level", "n"), [(0.5, 15), (0.9, 15), (0.9, 200), (0.95, 60)])
def test_the_range_of_coverage_holds_nineteen_of_twenty_independent_shares(level, n):
    low, high = coverage_range(level, n)
    shares = np.random.default_rng(3).binomial(n, level, 20_000) / n
    assert np.mean((low <= shares) & (shares <= high)) >= 0.945
    inner = np.mean((low < shares) & (shares < high))  # a smaller range would hold too few
    assert inner < 0.975


def test_a_wrong_speed_is_caught_along_the_track():
    caught = rejected(paths(20, np.random.default_rng(7), speed=0.95))
    assert sum("along" in names for names in caught) >= 18


def test_a_tenfold_overconfident_ensemble_is_caught_by_nees_and_coverage():
    caught = rejected(paths(20, np.random.default_rng(7)), spread=0.1)
    assert sum("nees" in names for names in caught) >= 16
    rng = np.random.default_rng(8)
    sharp = tracked(paths(400, rng, spread=0.1), rng)
    truths = tracked(paths(20, rng), rng)
    coverage = np.mean([ensemble_scores(sharp, one).coverage[1] for one in truths], axis=0)
    assert np.all(coverage < 0.75)


@pytest.mark.parametrize(("bias", "scale"), [(0.5, 1.0), (0.0, 0.4), (0.0, 2.5), (-0.3, 1.4)])
def test_scores_are_proper(bias, scale):
    rng = np.random.default_rng(4)
    truth = rng.standard_normal((2000, 2))
    honest = rng.standard_normal((60, 2000, 2))
    wrong = bias + scale * honest
    assert energy_score(honest, truth).mean() < energy_score(wrong, truth).mean()
    assert crps(honest, truth).mean() < crps(wrong, truth).mean()


@given(value=st.floats(-3, 3), seed=st.integers(0, 99))
def test_crps_is_the_energy_score_of_a_line(value, seed):
    draws = np.random.default_rng(seed).standard_normal((60, 1, 1))
    observed = np.array([[value]])
    np.testing.assert_allclose(
        energy_score(draws, observed), crps(draws, observed)[:, 0], atol=1e-12
    )


def test_crps_of_a_gaussian_is_its_closed_form():
    from scipy.stats import norm

    draws = norm.ppf((np.arange(20_000) + 0.5) / 20_000)
    y = 0.7
    expected = y * (2 * norm.cdf(y) - 1) + 2 * norm.pdf(y) - 1 / np.sqrt(np.pi)
    assert crps(draws, np.array(y)) == pytest.approx(expected, abs=1e-4)


def test_a_single_draw_scores_its_absolute_error():
    draws = np.zeros((1, 4, 3))
    observed = np.full((4, 3), 0.3)
    scores = ensemble_scores(draws, observed)
    np.testing.assert_allclose(scores.crps, 0.3)
    assert scores.energy == pytest.approx(0.3 * np.sqrt(2))


def test_a_whole_turn_of_yaw_is_no_error():
    rng = np.random.default_rng(2)
    draws = paths(100, rng)
    observed = draws[0] + [0, 0, 2 * np.pi]
    assert ensemble_scores(draws, observed).crps[2] < 0.1


def test_unknown_headings_leave_scores_of_position():
    rng = np.random.default_rng(2)
    draws, observed = paths(100, rng), paths(1, rng)[0]
    observed[:, 2] = np.nan
    scores = ensemble_scores(draws, observed)
    assert np.isfinite(scores.coverage[:, :2]).all()
    assert np.isnan(scores.coverage[:, 2]).all()
    names = [each.name for each in consistency(draws, observed)]
    assert names == ["nees", "along", "cross"]


def test_shapes_that_do_not_match_are_refused():
    with pytest.raises(DomainError, match="shape"):
        ensemble_scores(np.zeros((5, 4, 3)), np.zeros((3, 3)))
