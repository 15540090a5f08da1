# SPDX-License-Identifier: MIT
"""The departure is drawn with its band, and the data lie about it."""

import numpy as np

from model.slip.discrepancy import with_discrepancy
from support.figure_extents import overhang
from zebro_lab.plots import discrepancy


def test_median_and_bands_are_those_of_the_draws(rig):
    law = with_discrepancy(rig.law, 0.02, smallest=0.0, largest=1.0)
    n = len(law.parameters) - len(rig.truth)
    own = np.random.default_rng(1).normal(size=(101, n))
    draws = np.hstack([np.tile(rig.truth, (101, 1)), own])
    figure = discrepancy(rig.blocks, law, draws=draws, simulated=True)
    (axes,) = figure.axes
    assert figure.get_suptitle() == "Departure from the slip law (simulated)"
    (line,) = [each for each in axes.lines if each.get_label() == "posterior median"]
    expected = np.median(law.departure(line.get_xdata(), draws.T[:, :, None]), axis=0)
    np.testing.assert_allclose(line.get_ydata(), 100 * expected)
    points = axes.containers[0].lines[0]
    assert np.abs(points.get_ydata()).max() < 5  # the data are the law's own
    assert "[%]" in axes.get_ylabel()
    assert overhang(figure) <= 0
