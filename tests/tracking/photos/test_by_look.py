# SPDX-License-Identifier: MIT
"""A robot without a marker is tracked by its marked top, which must be in a usable photograph."""

from dataclasses import replace

import numpy as np
import pytest

from model.poses import relative
from tracking.errors import BodyError, NoUsablePhoto
from tracking.photos.by_look import (
    annotation_covariance,
    marked_top,
    pose_of_top,
    track_by_look,
)
from tracking.photos.floor_seen import see_floor
from tracking.photos.workers import NoProgress
from tracking.shared import ANNOTATION

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


def test_an_annotated_pose_errs_by_the_covariance_of_its_clicks(scene, photos, top):
    seen = see_floor(scene, photos[:1], robot=None, workers=1, progress=NoProgress())
    view = seen.fit.pose_of("p0.png")
    rng, first = np.random.default_rng(1), pose_of_top(top, scene, view)
    errors = []
    for _ in range(400):
        clicks = np.add(top.corners_px, top.corner_sd_px * rng.standard_normal((4, 2)))
        again = pose_of_top(replace(top, corners_px=tuple(map(tuple, clicks))), scene, view)
        errors.append(relative(again.planar, first.planar))
    stated = annotation_covariance(first, scene.prior)
    sd = np.sqrt(np.diag(stated))
    np.testing.assert_allclose(np.std(errors, axis=0), sd, rtol=0.15)
    np.testing.assert_allclose(np.corrcoef(np.transpose(errors)), stated / np.outer(sd, sd),
                               atol=0.2)  # fmt: skip


def test_clicks_that_are_off_move_the_whole_track_and_the_covariance_says_so(
    scene, photos, walk, top
):
    bare = replace(scene, robot=None, top=top)
    run = {"times": TIMES, "gap": None, "workers": 1, "progress": NoProgress()}
    right = track_by_look(bare, photos[:2], **run).track
    c, s = np.cos(0.03), np.sin(0.03)
    middle = np.mean(top.corners_px, axis=0)
    turned = (np.subtract(top.corners_px, middle) @ [[c, -s], [s, c]]) + middle + [0.8, 0.0]
    off = replace(top, corners_px=tuple(map(tuple, turned)))
    wrong = track_by_look(replace(bare, top=off), photos[:2], **run).track
    moved = [relative(a, b) for a, b in zip(right.poses, wrong.poses, strict=True)]
    assert np.all(np.abs(moved[0] - moved[1]) < [1e-3, 1e-3, 6e-3])  # alike, on the body
    assert abs(moved[0][2]) > 0.02
    slot = wrong.shared.slots[ANNOTATION]
    known = wrong.covariance_given([ANNOTATION])[0]
    assert wrong.covariance[0, 2, 2] > 2 * known[2, 2]
    assert wrong.joint.by_error[1][:, slot].any()


def test_a_poorly_known_lens_is_corrected_by_the_floor_for_the_robot_too(scene, photos, walk, top):
    # The camera's poses are those of the lens that the floor fits, not of the stated one.
    lens = scene.camera
    wrong = lens.matrix * [[1.08, 1, 1], [1, 1.08, 1], [1, 1, 1]]
    bent = [*lens.distortion, 0.15, 0, 0, 0, 0]
    sd = np.array([*(0.06 * lens.matrix[[0, 1], [0, 1]]), 3.0, 3.0, 0.1, 0, 0, 0, 0])
    poorly = replace(lens, matrix=wrong, distortion=bent, covariance=np.diag(sd**2))
    bare = replace(scene, camera=poorly, robot=None, top=top)
    found = track_by_look(bare, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress())
    off = found.track.poses - walk[:2]
    assert np.all(np.abs(off[:, 0]) < 2e-3)  # across the line of sight
    sd = np.sqrt(np.diagonal(found.track.covariance, axis1=1, axis2=2))
    assert np.all(np.abs(off) < 3 * sd)
