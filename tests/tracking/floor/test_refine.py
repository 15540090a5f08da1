# SPDX-License-Identifier: MIT
"""Floor and camera are fitted to all photographs; tape and pixels keep their own errors."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_floor import FLOOR, LENS, camera_pose, see
from tracking.errors import FloorError
from tracking.floor import FloorMap, FloorMarker, FloorView, refine_floor, split_stands


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
    for _ in range(8):
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
    for _ in range(20):
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
    views = [see(FLOOR, camera_pose(), rng, f"p{index}.jpg") for index in range(20)]
    assert set(split_stands(views)) == {0}
