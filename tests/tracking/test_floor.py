# SPDX-License-Identifier: MIT
"""The camera is found over the floor; bumps, mirrored maps and a slipped tape are told."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracking.camera import Camera, CameraPose, project
from tracking.errors import FloorError
from tracking.floor import (
    FloorMap,
    FloorMarker,
    FloorPoint,
    FloorView,
    locate_camera,
    refine_floor,
    split_stands,
)
from tracking.markers import Sighting

LENS = Camera((1280, 960), np.array([[1400.0, 0, 640], [0, 1400, 480], [0, 0, 1]]), np.zeros(5))
FLOOR = FloorMap(
    "4x4_50",
    tuple(
        FloorMarker(number, 0.1, x, y, yaw=0.3 * number)
        for number, (x, y) in enumerate([(0.3, -0.4), (2.0, -0.3), (2.1, 1.7), (-0.2, 1.6)], 10)
    ),
)
SIGMA = 0.05


def camera_pose(x=1.0, y=-1.6, z=2.6, pan=0.0) -> CameraPose:
    eye, target = np.array([x, y, z]), np.array([1.0, 0.7, 0.0])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.vstack((right, np.cross(ahead, right), ahead))
    c, s = np.cos(pan), np.sin(pan)
    rotation = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ rotation
    return CameraPose.from_matrix(rotation, -rotation @ eye)


def see(floor: FloorMap, pose: CameraPose, rng, name="photo.jpg") -> FloorView:
    sightings = [
        Sighting(
            marker.marker_id,
            project(LENS, pose, marker.points) + SIGMA * rng.standard_normal((4, 2)),
            SIGMA**2 * np.eye(8),
            1.0,
            0.7,
        )
        for marker in floor.markers
    ]
    return FloorView.of(name, sightings)


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


def test_one_marker_is_enough_but_uncertain():
    one = FloorMap("4x4_50", FLOOR.markers[:1])
    rng = np.random.default_rng(1)
    view = see(one, camera_pose(), rng)
    alone = locate_camera(LENS, one, view)
    together = locate_camera(LENS, FLOOR, see(FLOOR, camera_pose(), rng))
    assert np.trace(alone.covariance) > 10 * np.trace(together.covariance)


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
    with pytest.raises(FloorError, match="check positions"):
        locate_camera(LENS, wrong, view)


def test_a_mirrored_map_of_clicked_points_is_told():
    corners = {"a": (0, 0), "b": (2, 0), "c": (2, 1.5), "d": (0, 1.5), "e": (1, 0.4)}
    floor = FloorMap("4x4_50", points=tuple(FloorPoint(n, x, y) for n, (x, y) in corners.items()))
    clicked = {p.name: tuple(project(LENS, camera_pose(), p.points)[0]) for p in floor.points}
    with pytest.raises(FloorError, match="mirrored"):
        locate_camera(LENS, floor.mirrored(), FloorView.of("a.jpg").with_clicked(clicked))


def test_no_mark_of_the_floor_is_named_with_what_was_expected():
    with pytest.raises(FloorError, match=r"empty\.jpg: none of the floor's marks \(10, 11"):
        locate_camera(LENS, FLOOR, FloorView.of("empty.jpg"))


def test_a_number_seen_twice_is_left_out():
    view = see(FLOOR, camera_pose(), np.random.default_rng(3))
    double = Sighting(10, view.pixels[10] + 200, view.covariances[10], 1.0, 0.7)
    again = [Sighting(10, view.pixels[10], view.covariances[10], 1.0, 0.7), double]
    assert FloorView.of("a.jpg", again).pixels == {}


def test_a_mark_laid_down_twice_is_refused():
    with pytest.raises(FloorError, match="marker 10 twice"):
        FloorMap("4x4_50", (FLOOR.markers[0], FLOOR.markers[0]))


@pytest.mark.parametrize("degrees", [0.05, 0.3])
def test_a_bumped_tripod_is_noticed_where_it_happens(degrees):
    rng = np.random.default_rng(4)
    poses = [camera_pose()] * 6 + [camera_pose(pan=np.radians(degrees))] * 5
    views = [see(FLOOR, pose, rng, f"p{index}.jpg") for index, pose in enumerate(poses)]
    assert split_stands(views) == (0,) * 6 + (1,) * 5
    fit = refine_floor(LENS, FLOOR, views)
    assert "moved between p5.jpg and p6.jpg" in fit.warnings[0]
    turn = fit.pose_of("p0.jpg").rotation @ fit.pose_of("p10.jpg").rotation.T
    angle = np.degrees(np.arccos((np.trace(turn) - 1) / 2))
    assert angle == pytest.approx(degrees, rel=0.1)


def test_a_camera_at_rest_is_one_stand():
    rng = np.random.default_rng(5)
    views = [see(FLOOR, camera_pose(), rng, f"p{index}.jpg") for index in range(60)]
    assert set(split_stands(views)) == {0}


def test_a_photograph_without_marks_is_named_and_the_others_go_on():
    rng = np.random.default_rng(6)
    views = [see(FLOOR, camera_pose(), rng, f"p{index}.jpg") for index in range(3)]
    views.insert(1, FloorView.of("dark.jpg"))
    fit = refine_floor(LENS, FLOOR, views)
    assert set(fit.unused) == {"dark.jpg"}
    assert len(fit.stands) == 1
    with pytest.raises(FloorError, match=r"dark\.jpg"):
        fit.pose_of("dark.jpg")


def test_refined_marks_are_nearer_the_truth_than_the_tape():
    rng = np.random.default_rng(7)
    before, after = [], []
    for _ in range(15):
        tape = FloorMap(
            "4x4_50",
            tuple(
                FloorMarker(m.marker_id, m.side, *(np.array([m.x, m.y]) + rng.normal(0, 2e-3, 2)),
                            yaw=m.yaw, position_sd=2e-3)
                for m in FLOOR.markers
            ),
        )  # fmt: skip
        views = [
            see(FLOOR, camera_pose(), rng, "a.jpg"),
            see(FLOOR, camera_pose(x=0.2), rng, "b.jpg"),
        ]
        fit = refine_floor(LENS, tape, views)
        for found, floor in ((before, tape), (after, fit.floor)):
            # Distances between marks, which do not depend on where the tape put the origin.
            found.append([_distances(floor) - _distances(FLOOR)])
    assert np.std(after) < 0.8 * np.std(before)


def _distances(floor: FloorMap) -> np.ndarray:
    xy = np.array([(m.x, m.y) for m in floor.markers])
    return np.array([np.linalg.norm(a - b) for i, a in enumerate(xy) for b in xy[:i]])


def test_the_tape_is_part_of_the_cameras_covariance():
    rng = np.random.default_rng(8)
    truth, z = camera_pose(), []
    for _ in range(40):
        tape = FloorMap(
            "4x4_50",
            tuple(
                m.moved([*rng.normal(0, 1e-3, 2), rng.normal(0, 0.01), rng.normal(0, 2e-4)])
                for m in FLOOR.markers
            ),
        )
        pose = refine_floor(LENS, tape, [see(FLOOR, truth, rng)]).stands[0].pose
        error = np.concatenate((
            pose.rotation_vector - truth.rotation_vector, pose.translation - truth.translation
        ))  # fmt: skip
        z.append(error @ np.linalg.solve(pose.covariance, error))
    assert 4.0 < np.mean(z) < 8.0


def test_a_mark_far_from_its_tape_is_reported():
    rng = np.random.default_rng(9)
    markers = (FLOOR.markers[0].moved([0.02, 0, 0, 0]), *FLOOR.markers[1:])
    fit = refine_floor(LENS, FloorMap("4x4_50", markers), [see(FLOOR, camera_pose(), rng)])
    assert any(message.startswith("mark 1") for message in fit.warnings)


def test_a_picture_worse_than_it_seems_leaves_the_tape_its_own_error():
    rng = np.random.default_rng(7)
    view = see(FLOOR, camera_pose(), rng, "p.jpg")
    surer = {key: part / 3**2 for key, part in view.covariances.items()}
    told = FloorView(view.photo, view.pixels, surer)
    honest, misled = (refine_floor(LENS, FLOOR, [each]) for each in (view, told))
    assert (honest.noise_factor, honest.tape_factor, misled.tape_factor) == (1.0, 1.0, 1.0)
    assert 2.2 < misled.noise_factor < 3.8
    spread, same = (np.diag(fit.stands[0].pose.covariance) for fit in (honest, misled))
    np.testing.assert_allclose(np.sqrt(same / spread), 1.0, atol=0.25)


def test_a_tape_worse_than_it_is_said_to_be_widens_the_camera_and_not_the_pixels():
    rng = np.random.default_rng(8)
    slack = [
        replace(mark, x=mark.x + rng.normal(0, 6e-3), y=mark.y + rng.normal(0, 6e-3))
        for mark in FLOOR.markers
    ]
    fit = refine_floor(LENS, FloorMap("4x4_50", tuple(slack)), [see(FLOOR, camera_pose(), rng)])
    assert fit.noise_factor == 1.0
    assert 2.0 < fit.tape_factor < 9.0
