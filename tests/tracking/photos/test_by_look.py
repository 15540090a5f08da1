# SPDX-License-Identifier: MIT
"""A robot without a marker is tracked by its marked top, which must be in a usable photograph."""

from dataclasses import replace

import numpy as np
import pytest

from tracking.errors import BodyError, NoUsablePhoto
from tracking.photos.by_look import marked_top, pose_of_top, track_by_look
from tracking.photos.floor_seen import see_floor
from tracking.photos.workers import NoProgress

TIMES = {"p0.png": (0.0, 0.0), "p1.png": (2.0, 0.0)}


def test_the_robot_is_found_where_it_was(scene, photos, walk, top):
    bare = replace(scene, robot=None, top=top)
    found = track_by_look(bare, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress())
    np.testing.assert_allclose(found.track.poses[:, :2], walk[:2, :2], atol=4e-3)


def test_the_marked_top_must_be_known_and_its_photograph_usable(scene, photos, top, unreadable):
    seen = see_floor(scene, [photos[0], unreadable], robot=None, workers=1, progress=NoProgress())
    with pytest.raises(BodyError, match="not annotated"):
        marked_top(scene, seen, photos)
    with pytest.raises(NoUsablePhoto, match="not among"):
        marked_top(replace(scene, top=replace(top, photo="p9.png")), seen, photos)
    bad = replace(scene, top=replace(top, photo="bad.png"))
    with pytest.raises(NoUsablePhoto, match=r"bad.png: not a readable picture"):
        marked_top(bad, seen, [*photos, unreadable])
    assert marked_top(replace(scene, top=top), seen, photos) is top


def test_clicks_on_the_top_give_the_robots_pose(scene, photos, walk, top):
    seen = see_floor(scene, photos[:1], robot=None, workers=1, progress=NoProgress())
    pose = pose_of_top(top, scene, seen.fit.pose_of("p0.png"))
    np.testing.assert_allclose(pose.planar, walk[0], atol=2e-3)
