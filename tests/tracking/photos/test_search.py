# SPDX-License-Identifier: MIT
"""Markers are found in each photograph, and a bad one loses no other."""

from tracking.photos.search import Wanted, look_at, search_photos
from tracking.photos.workers import NoProgress


def wanted(scene, robot):
    return Wanted(scene.camera.size, scene.floor, robot)


def test_a_bad_photograph_is_named_and_loses_no_other(scene, robot, photos, unreadable):
    found = search_photos(
        [photos[0], unreadable, photos[1]], wanted(scene, robot), workers=1, progress=NoProgress()
    )
    assert [each.photo for each in found] == ["p0.png", "bad.png", "p1.png"]
    assert "not a readable picture" in (found[1].problem or "")
    for each in (found[0], found[2]):
        assert each.seen is not None
        assert set(each.seen.floor.pixels) == {10, 11, 12, 13}
        assert each.seen.robot is not None


def test_without_a_robot_only_the_floor_is_looked_for(scene, photos):
    seen = look_at(photos[0], wanted(scene, None)).seen
    assert seen is not None
    assert set(seen.floor.pixels) == {10, 11, 12, 13}
    assert seen.robot is None
