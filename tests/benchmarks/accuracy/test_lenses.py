# SPDX-License-Identifier: MIT
"""Boards are drawn in the picture; lenses of halves of real sets differ as much as they claim."""

import numpy as np
import pytest

from benchmarks.accuracy.lenses import (
    BOARD,
    PHOTOGRAPHS,
    SETS,
    SIZE,
    calibrated,
    drawn_camera,
    held,
    ratio,
    seen_boards,
)


@pytest.mark.parametrize("seed", range(3))
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


@pytest.mark.long
def test_a_drawn_lens_is_found_within_its_error():
    found = calibrated(0)
    assert found is not None
    assert np.abs(found[0]).max() < 4


@pytest.mark.long
@pytest.mark.reference
@pytest.mark.parametrize(("name", "model"), [("640 x 480", "full"), ("1920 x 1080", "k1-k2")])
def test_halves_of_a_real_set_differ_as_they_claim(shared, name, model):
    boards, size = seen_boards(shared, *SETS[name])
    found, pairs = ratio(boards, size, model)
    assert pairs >= 10
    assert 0.6 < found < 1.5
