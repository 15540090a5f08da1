# SPDX-License-Identifier: MIT
"""Floor and camera are fitted to all photographs that can be used."""

import numpy as np
import pytest

from tracking.errors import NoUsablePhoto
from tracking.photos.floor_seen import see_floor
from tracking.photos.workers import NoProgress


def seen_in(scene, photos):
    return see_floor(scene, photos, robot=None, workers=1, progress=NoProgress())


def test_the_camera_is_found_and_bad_photographs_are_named(scene, photos, unreadable):
    seen = seen_in(scene, [*photos[:2], unreadable])
    assert [each.photo for each in seen.detections] == ["p0.png", "p1.png"]
    assert list(seen.lost) == ["bad.png"]
    np.testing.assert_allclose(seen.fit.pose_of("p1.png").position, [0.6, -0.9, 1.4], atol=0.01)


def test_the_floors_markers_are_hidden_with_their_margin(scene, photos):
    seen = seen_in(scene, photos[:1])
    width, height = scene.camera.size
    hidden = seen.marks_in("p0.png", (height, width))
    for corners in seen.detections[0].floor.pixels.values():
        assert hidden[tuple(np.round(corners).astype(int).T[::-1])].all()
    assert 0.005 < hidden.mean() < 0.2
    assert not seen.marks_in("p9.png", (height, width)).any()


def test_no_photograph_at_all_is_said_with_the_first_reason(scene, unreadable):
    with pytest.raises(
        NoUsablePhoto, match=r"none of 2 .*bad.png: not a readable.*\(the same for 2"
    ):
        seen_in(scene, [unreadable, unreadable])
