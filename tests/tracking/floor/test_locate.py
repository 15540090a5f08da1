# SPDX-License-Identifier: MIT
"""The camera is found over the floor, and a mirrored map is told."""

import cv2
import numpy as np
import pytest

from support.drawn_floor import FLOOR, LENS, camera_pose, see
from tracking.camera import CameraPose, project
from tracking.errors import FloorError
from tracking.floor import FloorMap, FloorMarker, FloorPoint, FloorView, locate_camera
from tracking.markers import Sighting


def test_the_camera_is_found_within_its_covariance():
    rng, truth = np.random.default_rng(0), camera_pose()
    z = []
    for _ in range(40):
        found = locate_camera(LENS, FLOOR, see(FLOOR, truth, rng))
        error = np.concatenate((
            found.rotation_vector - truth.rotation_vector, found.translation - truth.translation
        ))  # fmt: skip
        z.append(error @ np.linalg.solve(found.covariance, error))
    assert 4.5 < np.mean(z) < 9.0


@pytest.mark.parametrize("turn_deg", [0.0, 30.0, 90.0, 180.0, 217.0])
def test_a_camera_that_looks_straight_down_is_found(turn_deg):
    c, s = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    rotation = np.array([[c, -s, 0], [-s, -c, 0], [0, 0, -1.0]])
    truth = CameraPose.from_matrix(rotation, -rotation @ np.array([1.0, 0.7, 2.6]))
    found = locate_camera(LENS, FLOOR, see(FLOOR, truth, np.random.default_rng(0)))
    np.testing.assert_allclose(found.position, [1.0, 0.7, 2.6], atol=5e-3)
    np.testing.assert_allclose(found.rotation @ rotation.T, np.eye(3), atol=5e-3)


def test_a_view_that_opencv_solves_with_no_number_places_the_camera(monkeypatch):
    nothing = ([np.full((3, 1), np.nan)] * 2, [np.full((3, 1), np.nan)] * 2)
    solve = cv2.solvePnPGeneric

    def without_ippe(*args, flags):
        if flags == cv2.SOLVEPNP_IPPE:
            return 2, *nothing, np.full((2, 1), np.nan)
        return solve(*args, flags=flags)

    monkeypatch.setattr("tracking.floor.locate.cv2.solvePnPGeneric", without_ippe)
    truth = camera_pose()
    found = locate_camera(LENS, FLOOR, see(FLOOR, truth, np.random.default_rng(0)))
    np.testing.assert_allclose(found.position, truth.position, atol=5e-3)


def test_clicked_points_place_the_camera():
    corners = {"a": (0, 0), "b": (2, 0), "c": (2, 1.5), "d": (0, 1.5), "e": (1, 0.4)}
    floor = FloorMap("4x4_50", points=tuple(FloorPoint(n, x, y) for n, (x, y) in corners.items()))
    truth = camera_pose()
    clicked = {p.name: tuple(project(LENS, truth, p.points)[0]) for p in floor.points}
    found = locate_camera(LENS, floor, FloorView.of("a.jpg").with_clicked(clicked))
    np.testing.assert_allclose(found.position, truth.position, atol=1e-6)


def test_three_points_are_too_few():
    floor = FloorMap("4x4_50", points=(FloorPoint("a", 0, 0), FloorPoint("b", 1, 0)))
    view = FloorView.of("p7.jpg").with_clicked({"a": (100, 100), "b": (300, 120)})
    with pytest.raises(FloorError, match=r"p7\.jpg: 2 points"):
        locate_camera(LENS, floor, view)


def test_a_mirrored_map_is_told_from_a_wrong_one():
    rng = np.random.default_rng(2)
    view = see(FLOOR, camera_pose(), rng, "p1.jpg")
    with pytest.raises(FloorError, match=r"p1\.jpg: the map of the floor is mirrored"):
        locate_camera(LENS, FLOOR.mirrored(), view)
    wrong = FloorMap("4x4_50", (FloorMarker(10, 0.1, 1.3, 0.4), *FLOOR.markers[1:]))
    with pytest.raises(FloorError, match="check x, y, yaw_deg"):
        locate_camera(LENS, wrong, view)


def test_no_mark_of_the_floor_is_named_with_what_was_expected():
    with pytest.raises(FloorError, match=r"empty\.jpg: none of the floor's marks \(10, 11"):
        locate_camera(LENS, FLOOR, FloorView.of("empty.jpg"))


def test_a_number_seen_twice_is_left_out():
    view = see(FLOOR, camera_pose(), np.random.default_rng(3))
    double = Sighting(10, view.pixels[10] + 200, view.covariances[10], 1.0, 0.7)
    again = [Sighting(10, view.pixels[10], view.covariances[10], 1.0, 0.7), double]
    assert FloorView.of("a.jpg", again).pixels == {}
