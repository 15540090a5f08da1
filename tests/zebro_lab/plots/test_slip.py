# SPDX-License-Identifier: MIT
"""Blocks and curves stand at the load that they belong to."""

from dataclasses import replace

import numpy as np
import pytest

from support.calibration_scenes import RIG_LOADS, labelled_lines, scatters


def test_every_block_is_drawn_once_and_at_its_nearest_load(rig):
    wholes = rig.curves().axes[::2]
    for load, axes in zip(RIG_LOADS, wholes, strict=True):
        points = np.concatenate([np.asarray(each.get_offsets()) for each in scatters(axes)])
        mine = np.argmin(np.abs(rig.blocks.normal_force[:, None] - RIG_LOADS), axis=1)
        rows = RIG_LOADS[mine] == load
        expected = np.column_stack([rig.blocks.slip[rows], rig.blocks.traction_force[rows]])
        np.testing.assert_allclose(sorted(points.tolist()), sorted(expected.tolist()))


def test_the_median_of_one_repeated_draw_is_the_law(tyre):
    repeated = replace(tyre, draws=np.tile(tyre.truth, (5, 1)))
    medians = labelled_lines(repeated.curves(), "posterior median")
    for load, line in zip(tyre.load_levels, medians, strict=True):
        slip, force = line.get_data()
        np.testing.assert_allclose(force, tyre.law.force(slip, load, tyre.truth))


def test_peaks_are_marked_where_the_tables_have_them(any_scene):
    low, high = any_scene.blocks.slip.min(), any_scene.blocks.slip.max()
    own = any_scene.law.peak_slip(any_scene.load_levels, any_scene.draws.T[:, :, None])
    tabled = [each for each in np.median(own, axis=0) if low < each < high]
    marks = labelled_lines(any_scene.curves(), "peak")
    found = {float(max(mark.get_xdata())) for mark in marks}
    np.testing.assert_allclose(sorted(found), sorted(tabled), rtol=1e-12)


def test_a_narrow_peak_gets_a_close_up_and_a_wide_one_none(rig, one_load, tyre):
    assert (len(rig.curves().axes), len(one_load.curves().axes)) == (8, 2)
    close = rig.curves().axes[1]
    assert close.get_xlim()[1] == pytest.approx(0.15, abs=0.01)
    assert len(tyre.curves().axes) == 4


@pytest.mark.parametrize("count", [1, 3, 5, 8])
def test_up_to_eight_loads_have_a_panel_each(rig, count):
    figure = replace(rig, load_levels=np.linspace(2, 16, count)).curves()
    assert len(figure.axes) == 2 * count
    assert max(figure.get_size_inches()) < 14


def test_a_load_without_blocks_still_shows_its_curve(one_load):
    figure = replace(one_load, load_levels=np.array([6.63, 100.0])).curves()
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert "load 100 N (no blocks)" in titles
    assert len(labelled_lines(figure, "posterior median")) == 4
