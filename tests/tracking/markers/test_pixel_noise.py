# SPDX-License-Identifier: MIT
"""A fit to pixels with correlated errors claims the spread that its unknowns have."""

import numpy as np
import pytest
from scipy import ndimage

from model.arrays import Array
from tracking.markers.pixel_noise import unknowns_covariance

_ROW, _COLUMN = np.indices((32, 36))
_POINTS = np.column_stack((_COLUMN.ravel(), _ROW.ravel())).astype(float)


def _design() -> Array:
    """Two edges that may move and blobs that may grow, over a plane of brightness."""
    x, y = _POINTS.T
    return np.column_stack(
        (
            np.exp(-0.5 * ((x - 9.3) / 1.2) ** 2),
            np.exp(-0.5 * ((y - 20.1) / 1.2) ** 2),
            np.exp(-0.5 * ((x - 24) ** 2 + (y - 11) ** 2) / 4),
            np.ones_like(x),
            x / 36,
            y / 32,
        )
    )


def _distance(*, smooth_px: float, lags: int, pictures: int = 300) -> float:
    """Mean squared error of three unknowns by their covariance, over its number of unknowns."""
    rng = np.random.default_rng(1)
    design = _design()
    inverse = np.linalg.inv(design.T @ design)
    squares = []
    for _ in range(pictures):
        noise = rng.normal(size=_ROW.shape)
        noise = ndimage.gaussian_filter(noise, smooth_px, mode="wrap").ravel()
        error = inverse @ (design.T @ noise)
        covariance = unknowns_covariance(
            _POINTS, design, inverse, noise - design @ error, first=3, lags=lags
        )
        squares.append(error[:3] @ np.linalg.solve(covariance, error[:3]) / 3)
    return float(np.mean(squares))


def test_unknowns_spread_as_claimed_under_independent_errors():
    assert _distance(smooth_px=0.0, lags=8) == pytest.approx(1.0, abs=0.15)


def test_unknowns_spread_as_claimed_under_correlated_errors():
    # Covariance by the number of pixels alone gives 16 here.
    assert _distance(smooth_px=1.5, lags=8) == pytest.approx(1.0, abs=0.2)


def test_errors_beyond_the_largest_lag_are_left_out():
    assert _distance(smooth_px=1.5, lags=1) > 1.5


def test_covariance_has_the_units_of_the_errors_squared():
    design = _design()
    inverse = np.linalg.inv(design.T @ design)
    residual = np.random.default_rng(2).normal(size=len(_POINTS))
    once, twice = (
        unknowns_covariance(_POINTS, design, inverse, factor * residual, first=3, lags=8)
        for factor in (1.0, 2.0)
    )
    np.testing.assert_allclose(twice, 4 * once, rtol=1e-4)
