# SPDX-License-Identifier: MIT
"""Points and curves stand at the load that they belong to."""

from dataclasses import replace

import numpy as np

from support.calibration_scenes import RIG_LOADS, labelled_lines


def test_every_block_is_drawn_once_and_at_its_nearest_load(rig):
    lines = labelled_lines(rig.curves(), "block means, as measured")[::2]
    mine = np.argmin(np.abs(rig.blocks.normal_force[:, None] - RIG_LOADS), axis=1)
    for index, line in enumerate(lines):
        rows = mine == index
        expected = [rig.blocks.slip[rows], rig.blocks.traction_force[rows]]
        np.testing.assert_array_equal(line.get_data(), expected)


def test_corrected_points_are_moved_to_the_load_of_their_curve(rig):
    exact = replace(rig, draws=np.tile(rig.truth, (5, 1)))
    found, (load,) = labelled_lines(exact.curves(), "corrected")[0], RIG_LOADS[:1]
    rows = np.abs(rig.blocks.normal_force - load) < 0.2 * load
    slip, force = rig.corrected.slip[rows], rig.corrected.traction_force[rows]
    own = rig.law.force(slip, rig.corrected.normal_force[rows], rig.truth)
    expected = [slip, force + rig.law.force(slip, load, rig.truth) - own]
    np.testing.assert_allclose(found.get_data(), expected)


def test_runs_are_drawn_by_their_means_and_of_many_blocks_some(tyre, rig):
    (first, *_) = labelled_lines(rig.curves(of_runs=True), "run means, as measured")
    rows = rig.blocks.normal_force < 4.0
    means = [np.mean(rig.blocks.traction_force[rows & (rig.blocks.run == run)]) for run in range(3)]
    np.testing.assert_allclose(first.get_ydata()[:3], means)
    assert len(first.get_xdata()) == len(np.unique(rig.blocks.run[rows]))
    some = labelled_lines(tyre.curves(), "corrected")[0]
    assert len(some.get_xdata()) == 150 < np.sum(tyre.blocks.normal_force < 750.0)


def test_the_median_of_one_repeated_draw_and_the_plain_fit_are_the_law(tyre):
    figure = replace(tyre, draws=np.tile(tyre.truth, (5, 1))).curves()
    for label, values in (("posterior median", tyre.truth), ("plain fit", 0.9 * tyre.truth)):
        for load, line in zip(tyre.load_levels, labelled_lines(figure, label), strict=True):
            slip, force = line.get_data()
            np.testing.assert_allclose(force, tyre.law.force(slip, load, values))


def test_peaks_are_marked_within_the_tested_slip(any_scene):
    low, high = any_scene.blocks.slip.min() - 0.001, any_scene.blocks.slip.max()
    own = any_scene.law.peak_slip(any_scene.load_levels, any_scene.truth)
    inside = {s * each for each in np.broadcast_to(own, len(any_scene.load_levels))
              for s in (1, -1) if low < s * each < high}  # fmt: skip
    marks = labelled_lines(any_scene.curves(), "peak")
    assert {x for mark in marks for x in mark.get_xdata()} == inside
