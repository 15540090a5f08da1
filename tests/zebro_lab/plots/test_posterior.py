# SPDX-License-Identifier: MIT
"""Regions of a posterior hold the draws that they name, and every chain has a line."""

import numpy as np
import pytest

from support.calibration_scenes import SCREEN
from zebro_lab.plots import save
from zebro_lab.plots.posterior import corner


def test_regions_of_highest_density_hold_the_draws_they_name():
    draws = np.random.default_rng(3).normal(size=(4000, 2)) @ [[1.0, 0.6], [0.0, 0.8]]
    figure = corner(draws, labels=("a [-]", "b [-]"), page=SCREEN)
    pair = next(axes for axes in figure.axes if axes.get_xlabel() and axes.get_ylabel())
    (regions,) = [each for each in pair.collections if len(each.get_paths()) == 2]
    outer, inner = (path.contains_points(draws).mean() for path in regions.get_paths())
    assert outer == pytest.approx(0.9, abs=0.04)  # contains_points fills the hole in the outer
    assert inner == pytest.approx(0.5, abs=0.06)


def test_a_posterior_of_one_point_or_one_parameter_is_drawn(tmp_path):
    point = corner(np.ones((50, 2)), labels=("a [-]", "b [-]"), page=SCREEN)
    line = corner(np.linspace(0, 1, 50)[:, None], labels=("a [N]",), page=SCREEN)
    save(point, tmp_path / "point.png")
    save(line, tmp_path / "line.png")
    assert (len(point.axes), len(line.axes)) == (3, 1)
