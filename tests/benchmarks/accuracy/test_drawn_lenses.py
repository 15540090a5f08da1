# SPDX-License-Identifier: MIT
"""Boards are drawn in the picture, and intervals are counted."""

import numpy as np
import pytest

from benchmarks.accuracy.drawn_lenses import (
    BOARD,
    PHOTOGRAPHS,
    SIZE,
    Calibrated,
    calibrated,
    drawn_camera,
    held,
    holding,
)


@pytest.mark.parametrize("seed", range(5))
def test_corners_of_the_boards_are_in_the_picture_and_cover_much_of_it(seed):
    rng = np.random.default_rng(seed)
    camera = drawn_camera(rng)
    sheets = [held(camera, place, rng) for place in range(PHOTOGRAPHS)]
    across, down = (0.5 * BOARD.square * (n - 1) for n in (BOARD.columns, BOARD.rows))
    corners = np.concatenate(
        [camera.project(sheet.at([-across, across] * 2, [-down] * 2 + [down] * 2))
         for sheet in sheets]
    )  # fmt: skip
    assert (corners > 0).all()
    assert (corners < SIZE).all()
    assert (np.ptp(corners, axis=0) > 0.6 * np.array(SIZE)).all()


def test_intervals_that_hold_the_truth_are_counted():
    sets = [Calibrated(np.array([0.0, 1.6, 1.7, -3.0]), "full")] * 40
    found, (low, high) = holding(sets)
    assert found.tolist() == [40, 40, 0, 0]
    assert (low, high) == (29, 40)


@pytest.mark.long
def test_a_drawn_lens_is_found_within_its_error():
    found = calibrated(0)
    assert found is not None
    assert np.abs(found.errors).max() < 4
