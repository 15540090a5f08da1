# SPDX-License-Identifier: MIT
"""Errors that neighbouring corners share are told from noise, and widen the lens's covariance."""

import numpy as np
import pytest

from tracking.camera.corner_errors import FittedBoard, corner_errors

COLUMNS, ROWS, SQUARE = 9, 6, 0.03


def fitted(smooth: float, rng: np.random.Generator, *, views=14, noise=0.1):
    """Fit two parameters and a pose of each board to drawn errors; return boards, parameters."""
    column, row = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    points = SQUARE * np.column_stack((column.ravel(), row.ravel()))
    n = len(points)
    apart = np.sum((points[:, None] - points[None]) ** 2, axis=2)
    K = np.exp(-apart / (2 * 0.06**2))
    root = np.linalg.cholesky(K + 1e-9 * np.eye(n))
    boards, normal, pull = [], np.zeros((2, 2)), np.zeros(2)
    for _ in range(views):
        u = (points - points.mean(axis=0)) / 0.1
        tilt = rng.normal(size=2)
        affine = np.zeros((n, 2, 6))
        affine[:, 0, :3] = affine[:, 1, 3:] = np.column_stack((np.ones(n), u))
        away = (u @ tilt)[:, None]
        by_lens = np.stack((u * away**2, u * (u**2).sum(axis=1, keepdims=True)), axis=2)
        error = noise * rng.normal(size=(n, 2)) + smooth * root @ rng.normal(size=(n, 2))
        boards.append((affine, by_lens, error))
        flat = affine.reshape(-1, 6)
        left = by_lens.reshape(-1, 2)
        left = left - flat @ np.linalg.lstsq(flat, left, rcond=None)[0]
        normal, pull = normal + left.T @ left, pull + left.T @ error.ravel()
    lens = np.linalg.solve(normal, pull)
    found = []
    for affine, by_lens, error in boards:
        rest = error - by_lens @ lens
        flat = affine.reshape(-1, 6)
        rest = rest.ravel() - flat @ np.linalg.lstsq(flat, rest.ravel(), rcond=None)[0]
        found.append(FittedBoard(points, rest.reshape(-1, 2), affine, by_lens))
    return found, lens


def test_noise_and_smooth_errors_are_distinguished():
    boards, _ = fitted(0.2, np.random.default_rng(1))
    errors = corner_errors(boards)
    assert errors.noise == pytest.approx(0.1, rel=0.1)
    assert errors.smooth == pytest.approx(0.2, rel=0.35)
    alone = corner_errors(fitted(0.0, np.random.default_rng(2))[0])
    assert alone.smooth < 0.03
    assert alone.noise == pytest.approx(0.1, rel=0.05)


@pytest.mark.parametrize("smooth", [0.0, pytest.param(0.3, marks=pytest.mark.long)])
def test_the_lens_errs_by_its_covariance(smooth):
    rng = np.random.default_rng(3)
    squares = []
    for _ in range(60):
        boards, lens = fitted(smooth, rng, views=7)
        covariance = corner_errors(boards).covariance
        squares.append(lens @ np.linalg.solve(covariance, lens) / 2)
    assert np.mean(squares) == pytest.approx(1.0, abs=0.3)


def test_corners_without_errors_leave_next_to_none():
    errors = corner_errors(fitted(0.0, np.random.default_rng(5), noise=0.0)[0])
    assert 0 <= errors.noise < 1e-5
    assert np.all(np.isfinite(errors.covariance))
