# SPDX-License-Identifier: MIT
"""Blocks and curves stand at the load that they belong to."""

from dataclasses import replace

import numpy as np

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
