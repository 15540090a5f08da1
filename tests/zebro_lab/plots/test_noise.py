# SPDX-License-Identifier: MIT
"""Residuals are shown as they are, and never paired across runs."""

from dataclasses import replace

import numpy as np
import pytest

from support.calibration_scenes import SCREEN
from zebro_lab.plots.noise import residuals


def test_lags_are_drawn_with_the_band_of_white_noise(rig):
    rng = np.random.default_rng(1)
    n = len(rig.blocks.slip)
    figure = residuals(rig.blocks, whitened=rng.normal(size=n), run_score=rng.normal(size=5),
                       page=SCREEN)  # fmt: skip
    lags = figure.axes[2]
    points = next(line for line in lags.lines if line.get_marker() == "o")
    assert points.get_xdata().tolist() == [1, 2]  # three blocks a run
    chance = [bar.get_height() / 2 for bar in lags.patches]
    runs = int(rig.blocks.run[-1]) + 1
    pairs = [n - runs, n - 2 * runs]  # of neighbours, and of next neighbours
    assert chance[0] == pytest.approx(1.96 / np.sqrt(pairs[0]), rel=0.02)
    assert chance[1] == pytest.approx(1.96 / np.sqrt(pairs[1]), rel=0.05)
    assert (lags.get_xlabel(), lags.get_ylabel()) == (
        "lag within a run [blocks]", "autocorrelation [-]",
    )  # fmt: skip


def test_runs_are_drawn_by_rank(rig):
    score = np.array([1.0, -2.0, 0.5])
    figure = residuals(rig.blocks, whitened=np.zeros(len(rig.blocks.slip)) + 1e-3,
                       run_score=score, page=SCREEN)  # fmt: skip
    points = next(line for line in figure.axes[3].lines if line.get_marker() == "o")
    np.testing.assert_array_equal(points.get_xydata(), [[1, -2.0], [2, 0.5], [3, 1.0]])


def test_a_lag_of_few_pairs_is_not_drawn(rig):
    run = np.repeat(np.arange(5), [3, 3, 3, 3, 9])  # of lag 2 there are 11 pairs, of lag 3 six
    all_blocks = rig.blocks
    blocks = replace(
        all_blocks, slip=all_blocks.slip[:21], normal_force=all_blocks.normal_force[:21],
        traction_force=all_blocks.traction_force[:21], run=run,
    )  # fmt: skip
    figure = residuals(blocks, whitened=np.ones(21), run_score=np.zeros(5), page=SCREEN)
    points = next(line for line in figure.axes[2].lines if line.get_marker() == "o")
    np.testing.assert_allclose(points.get_xydata(), [[1, 1.0], [2, 1.0]])
