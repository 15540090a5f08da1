# SPDX-License-Identifier: MIT
"""A photograph gives the robot and the floor; what is wrong with it is said with its name."""

import json

import cv2
import numpy as np
import pytest

from tracking.camera import Camera
from tracking.detect import MarkedRobot, RobotMarker, detect, observe
from tracking.errors import PhotoError
from tracking.floor import FloorMap, FloorMarker, refine_floor
from tracking.markers import dictionary_named
from tracking.path import assemble_track
from tracking.pose import BodyPrior

ROBOT = MarkedRobot(RobotMarker(0, 0.12, "4x4_50", (0, 0, 0.0385)), BodyPrior(0.0615))
FLOOR = FloorMap("4x4_50", (FloorMarker(10, 0.1, 0, 0), FloorMarker(11, 0.1, 1, 0)))


def sheet(*markers, dictionary="4x4_50", side=80):
    picture = np.full((360, 160 * max(len(markers), 1)), 255, np.uint8)
    for index, number in enumerate(markers):
        drawn = cv2.aruco.generateImageMarker(dictionary_named(dictionary), number, side)
        picture[120 : 120 + side, 40 + 160 * index : 40 + 160 * index + side] = drawn
    return picture


def test_two_robots_are_refused_by_name():
    with pytest.raises(PhotoError, match=r"p4\.jpg: the robot's marker 0 is seen 2 times"):
        detect("p4.jpg", sheet(10, 0, 0), floor=FLOOR, robot=ROBOT)


def test_a_wrong_dictionary_is_told_from_an_empty_floor():
    other = sheet(10, 11, 0, dictionary="5x5_50")
    with pytest.raises(PhotoError, match=r"p1\.jpg.*markers of '5x5_50'"):
        detect("p1.jpg", other, floor=FLOOR, robot=ROBOT)
    with pytest.raises(PhotoError, match=r"p2\.jpg: none of the floor's markers \(10, 11"):
        detect("p2.jpg", sheet(), floor=FLOOR, robot=ROBOT)


def test_a_photograph_without_the_robot_still_shows_the_floor():
    found = detect("p.jpg", sheet(10, 11), floor=FLOOR, robot=ROBOT)
    assert found.robot is None
    assert set(found.floor.pixels) == {10, 11}


def test_a_hint_changes_where_is_looked_and_not_what_is_found():
    picture = sheet(10, 11, 0)
    plain = detect("a.jpg", picture, floor=FLOOR, robot=ROBOT)
    hinted = detect("b.jpg", picture, floor=FLOOR, robot=ROBOT, hint=plain)
    np.testing.assert_allclose(hinted.robot.corners_px, plain.robot.corners_px, atol=0.02)
    moved = np.roll(picture, 130, axis=0)
    far = detect("c.jpg", moved, floor=FLOOR, robot=ROBOT, hint=plain)
    assert set(far.floor.pixels) == {10, 11}


@pytest.mark.reference
def test_a_marked_walk_goes_from_photographs_to_a_track(shared):
    folder = shared / "virtual-world/photos"
    world = json.loads((folder / "camera.json").read_text(encoding="utf-8"))
    lens = Camera((1280, 960), np.array(world["K"]), np.zeros(5))
    floor = FloorMap("4x4_50", tuple(
        FloorMarker(int(key), value["side"], *np.mean(value["corners_world"], axis=0)[:2], z=0.002)
        for key, value in world["floor_markers"].items()
    ))  # fmt: skip
    paths = sorted((folder / "s1.10_A").glob("*.jpg"))[::3]
    detections, hint = [], None
    for path in paths:
        hint = detect(path.name, cv2.imread(str(path)), floor=floor, robot=ROBOT, hint=hint)
        detections.append(hint)
    fit = refine_floor(lens, floor, [detection.floor for detection in detections])
    times = {path.name: (6.0 * index, 0.0) for index, path in enumerate(paths)}
    seen = observe(fit, detections, robot=ROBOT, times=times)
    track = assemble_track(seen, shared=fit.shared, prior=ROBOT.prior)
    assert len(track.t) == len(paths)
