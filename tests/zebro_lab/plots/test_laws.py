# SPDX-License-Identifier: MIT
"""Curves of several laws lie where the laws have them, on a scale that shows rise and fall."""

from dataclasses import replace

import numpy as np
import pytest

from model.slip import Brush
from support.calibration_scenes import RIG_LOADS, SCREEN
from support.figure_extents import overhang
from zebro_lab.plots.laws import slip_laws


@pytest.fixture(scope="module")
def figure(rig):
    laws = {"truth": (rig.law, np.tile(rig.truth, (3, 1))),
            "brush": (Brush(), np.tile((20.4, 0.38), (3, 1)))}  # fmt: skip
    exact = rig.law.force(rig.blocks.slip, rig.blocks.normal_force, rig.truth)
    blocks = replace(rig.blocks, traction_force=exact + 0.07)
    return slip_laws(blocks, laws, reference="truth", load_levels=RIG_LOADS, page=SCREEN)


def test_each_load_has_curves_and_their_difference_from_the_fitted_one(figure, rig):
    assert len(figure.axes) == 2 * len(RIG_LOADS)
    for row, load in enumerate(RIG_LOADS):
        whole, beside = figure.axes[2 * row : 2 * row + 2]
        own, brush = whole.lines[:2]
        slip = np.asarray(own.get_xdata())
        np.testing.assert_allclose(own.get_ydata(), rig.law.force(slip, load, rig.truth))
        expected = np.asarray(brush.get_ydata()) - np.asarray(own.get_ydata())
        lines = [each for each in beside.lines if len(each.get_xdata()) == len(slip)]
        np.testing.assert_allclose(lines[1].get_ydata(), expected)
        (points,) = beside.containers
        np.testing.assert_allclose(np.asarray(points.lines[0].get_ydata(), dtype=float), 0.07)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "truth (fitted)" in labels


def test_axes_have_units_and_nothing_is_beyond_the_page(figure):
    assert all("[" in axes.get_ylabel() for axes in figure.axes)
    assert overhang(figure) <= 0
