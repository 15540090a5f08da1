# SPDX-License-Identifier: MIT
"""A robot without a marker is tracked by its marked top, which must be in a usable photograph."""

from dataclasses import replace

import numpy as np
import pytest

from model.poses import relative
from tracking.camera import project
from tracking.errors import BodyError, NoUsablePhoto
from tracking.images import read_pixels
from tracking.photos.by_look import (
    marked_tops,
    missed_too_far,
    nearest_of,
    pose_of_top,
    refined_pose,
    track_by_look,
)
from tracking.photos.floor_seen import see_floor
from tracking.photos.workers import NoProgress
from tracking.pose import rotation_with_derivatives
from tracking.shared import annotation_name

TIMES = {"p0.png": (0.0, 0.0), "p1.png": (2.0, 0.0)}


@pytest.fixture(scope="module")
def found(scene, photos, top):
    """Track the robot of two photographs by its top in the first."""
    bare = replace(scene, robot=None, tops=(top,))
    return track_by_look(bare, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress())


def test_the_robot_is_found_where_it_was(found, walk):
    np.testing.assert_allclose(found.track.poses[:, :2], walk[:2, :2], atol=4e-3)


def test_the_marked_top_must_be_known_and_its_photograph_usable(scene, photos, top, unreadable):
    seen = see_floor(scene, [photos[0], unreadable], robot=None, workers=1, progress=NoProgress())
    with pytest.raises(BodyError, match="not annotated"):
        marked_tops(scene, seen, photos)
    with pytest.raises(NoUsablePhoto, match="not among"):
        marked_tops(replace(scene, tops=(replace(top, photo="p9.png"),)), seen, photos)
    bad = replace(scene, tops=(replace(top, photo="bad.png"),))
    with pytest.raises(NoUsablePhoto, match=r"bad.png: not a readable picture"):
        marked_tops(bad, seen, [*photos, unreadable])
    assert marked_tops(replace(scene, tops=(top,)), seen, photos) == (top,)


def test_edges_of_the_top_refine_its_heading_and_a_contradiction_is_said(
    scene, plain_photos, walk, top
):
    seen = see_floor(scene, plain_photos, robot=None, workers=1, progress=NoProgress())
    view, pixels = seen.fit.pose_of("p0.png"), read_pixels(plain_photos[0].path)
    clicked = pose_of_top(top, scene, view).covariance
    annotated, corners = refined_pose(top, scene, view, pixels)
    assert corners.sides >= 3
    np.testing.assert_allclose(annotated.pose.planar, walk[0], atol=2e-3)
    assert annotated.covariance[5, 5] < 0.5 * clicked[5, 5]
    aside = tuple((u + 3.0, v) for u, v in top.corners_px)
    off = replace(scene, robot=None, tops=(replace(top, corners_px=aside, corner_sd_px=0.2),))
    found = track_by_look(
        off, plain_photos, times=TIMES, gap=None, workers=1, progress=NoProgress()
    )
    assert any("clicked corners of the robot's top in p0.png do not fit" in n for n in found.notes)


def test_clicks_that_no_pose_of_the_top_explains_are_told(scene, photos, top):
    view = see_floor(scene, photos[:1], robot=None, workers=1, progress=NoProgress()).fit.pose_of(
        "p0.png"
    )

    def too_far(clicks, plate=top.plate) -> bool:
        """Fit the pose to clicks and compare."""
        clicked = replace(top, corners_px=tuple(map(tuple, clicks)), plate=plate)
        pose = pose_of_top(clicked, scene, view)
        return missed_too_far(pose, np.subtract(clicks, pose.corners_px), top.corner_sd_px)

    clicks = np.array(top.corners_px)
    noise = np.random.default_rng(0).normal(0, top.corner_sd_px, (50, 4, 2))
    assert not any(too_far(clicks + each) for each in noise)
    assert too_far(clicks[[1, 0, 3, 2]])  # left and right taken for each other
    assert too_far(clicks, replace(top.plate, length=top.plate.length - 0.02))


def test_clicks_that_are_off_move_the_whole_track_and_the_covariance_says_so(
    found, scene, photos, top
):
    right = found.track
    c, s = np.cos(0.03), np.sin(0.03)
    middle = np.mean(top.corners_px, axis=0)
    turned = (np.subtract(top.corners_px, middle) @ [[c, -s], [s, c]]) + middle + [0.8, 0.0]
    off = replace(top, corners_px=tuple(map(tuple, turned)))
    moved_top = replace(scene, robot=None, tops=(off,))
    wrong = track_by_look(
        moved_top, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress()
    ).track
    moved = [relative(a, b) for a, b in zip(right.poses, wrong.poses, strict=True)]
    assert np.all(np.abs(moved[0] - moved[1]) < [1e-3, 1e-3, 6e-3])  # alike, on the body
    assert abs(moved[0][2]) > 0.02
    name = annotation_name(top.photo)
    slot = wrong.shared.slots[name]
    known = wrong.covariance_given([name])[0]
    assert wrong.covariance[0, 2, 2] > 2 * known[2, 2]
    assert wrong.joint.by_error[1][:, slot].any()


def test_a_poorly_known_lens_is_corrected_by_the_floor_for_the_robot_too(scene, photos, walk, top):
    # The camera's poses are those of the lens that the floor fits, not of the stated one.
    lens = scene.camera
    wrong = lens.matrix * [[1.08, 1, 1], [1, 1.08, 1], [1, 1, 1]]
    bent = np.add(lens.distortion, [0.15, 0, 0, 0, 0])
    sd = np.array([*(0.06 * lens.matrix[[0, 1], [0, 1]]), 3.0, 3.0, 0.1, 0, 0, 0, 0])
    poorly = replace(lens, matrix=wrong, distortion=bent, covariance=np.diag(sd**2))
    bare = replace(scene, camera=poorly, robot=None, tops=(top,))
    found = track_by_look(bare, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress())
    off = found.track.poses - walk[:2]
    assert np.all(np.abs(off[:, 0]) < 2e-3)  # across the line of sight
    sd = np.sqrt(np.diagonal(found.track.covariance, axis1=1, axis2=2))
    assert np.all(np.abs(off) < 3 * sd)


@pytest.mark.long
def test_with_several_annotated_photographs_each_gives_the_template_of_those_near_it(
    scene, photos, walk, top
):
    assert nearest_of(["a", "b", "c", "d", "e"], ["d", "a"]) == {
        "a": "a", "b": "a", "c": "d", "d": "d", "e": "d",
    }  # fmt: skip
    times = {photo.name: (2.0 * k, 0.0) for k, photo in enumerate(photos)}
    run = {"times": times, "gap": None, "workers": 1, "progress": NoProgress()}
    one = track_by_look(replace(scene, robot=None, tops=(top,)), photos, **run)
    x, y, yaw = walk[2]
    R, _ = rotation_with_derivatives(0.0, 0.0, yaw)
    view = one.floor.fit.pose_of(photos[2].name)
    at = project(scene.camera, view, top.plate.corners_body @ R.T + [x, y, scene.prior.height])
    last = replace(top, photo=photos[2].name, corners_px=tuple(map(tuple, at)))
    both = track_by_look(replace(scene, robot=None, tops=(top, last)), photos, **run)
    assert [seen.annotated for seen in both.track.observations] == ["p0.png", "p0.png", "p2.png"]
    assert {annotation_name("p0.png"), annotation_name("p2.png")} <= set(both.track.shared.slots)
    assert np.all(both.track.covariance[:, 2, 2] < 0.97 * one.track.covariance[:, 2, 2])
    np.testing.assert_allclose(both.track.poses[:, :2], walk[:, :2], atol=4e-3)
