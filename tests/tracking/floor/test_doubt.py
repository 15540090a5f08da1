# SPDX-License-Identifier: MIT
"""A mark or a lens that is far off is suspected, and nothing is on a sound floor."""

import re
from dataclasses import replace

import numpy as np
import pytest

from support.drawn_floor import FLOOR, LENS, camera_pose, see
from tracking.camera import Camera
from tracking.floor import FloorMap, refine_floor


def suspects_of(*, floor: FloorMap = FLOOR, lens: Camera = LENS, seed: int = 1) -> str:
    """Return what is suspected where these are stated."""
    view = see(FLOOR, camera_pose(), np.random.default_rng(seed))
    return " ".join(refine_floor(lens, floor, [view]).suspicion)


def taped(rng: np.random.Generator) -> FloorMap:
    laid = FLOOR.markers
    return FloorMap("4x4_50", tuple(m.moved(m.prior_sd * rng.normal(size=4)) for m in laid))


def test_sound_floors_raise_no_suspicion():
    said = [suspects_of(floor=taped(np.random.default_rng(k)), seed=k) for k in range(20)]
    assert sum(map(bool, said)) <= 2


def test_a_mark_that_is_far_off_is_named_with_its_shift():
    moved = (FLOOR.markers[0].moved([0.02, 0, 0, 0]), *FLOOR.markers[1:])
    text = suspects_of(floor=FloorMap("4x4_50", moved))
    assert text.startswith("the place of mark 10 in floor.toml")
    x, y = map(float, re.findall(r"([-+][\d.]+) mm in", text))
    assert x == pytest.approx(-20, abs=3)
    assert y == pytest.approx(0, abs=3)


def test_a_focal_length_that_is_off_is_named():
    longer = replace(LENS, matrix=LENS.matrix * [[1.03, 1, 1], [1, 1.03, 1], [1, 1, 1]])
    assert "the focal length in camera.toml" in suspects_of(lens=longer)
