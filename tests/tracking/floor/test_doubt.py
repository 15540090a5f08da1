# SPDX-License-Identifier: MIT
"""A mark or a lens that is far off is suspected, and nothing is on a sound floor."""

import re
from dataclasses import replace

import numpy as np
import pytest

from support.drawn_floor import FLOOR, LENS, camera_pose, see
from tracking.camera import Camera
from tracking.floor import FloorMap, refine_floor
from tracking.floor.doubt import SuspectValue, suspicion


def suspects_of(*, floor: FloorMap = FLOOR, lens: Camera = LENS, seed: int = 1) -> str:
    """Return what is suspected where these are stated."""
    view = see(FLOOR, camera_pose(), np.random.default_rng(seed))
    return " ".join(refine_floor(lens, floor, [view]).suspicion)


def taped(rng: np.random.Generator) -> FloorMap:
    laid = FLOOR.markers
    return FloorMap("4x4_50", tuple(m.moved(m.prior_sd * rng.normal(size=4)) for m in laid))


def test_sound_floors_raise_no_suspicion():
    said = [suspects_of(floor=taped(np.random.default_rng(k)), seed=k) for k in range(8)]
    assert sum(map(bool, said)) <= 1


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


def test_no_suspect_below_the_threshold_is_named():
    assert suspicion([], remarkable=2.0) == ()
    assert suspicion([SuspectValue("the lens", "+1 % off", 1.9)], remarkable=2.0) == ()
    assert suspicion([SuspectValue("the lens", "+1 % off", 2.1)], remarkable=2.0) != ()


def test_a_clear_suspect_is_named_alone():
    clear = [SuspectValue("the lens", "+1 % off", 20.0), SuspectValue("the tape", "2 mm off", 5.0)]
    (text,) = suspicion(clear, remarkable=2.0)
    assert text.startswith("the lens does not fit the photographs: it seems to be +1 % off")
    assert "tape" not in text


def test_a_rival_is_named_up_to_four_less_likely():
    for less, named in ((3.9, True), (4.1, False)):
        pair = [
            SuspectValue("the lens", "+1 % off", 6.0),
            SuspectValue("the tape", "2 mm off", 6.0 - less),
        ]
        (text,) = suspicion(pair, remarkable=2.0)
        assert ("tape" in text) == named
