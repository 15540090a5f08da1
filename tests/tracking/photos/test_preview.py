# SPDX-License-Identifier: MIT
"""One photograph tells its scale, where the robot is, and whether the tape agrees."""

from dataclasses import replace

import numpy as np
import pytest

from tracking.errors import PhotoError
from tracking.photos.preview import preview_photo


def test_tape_and_photograph_agree_and_the_robot_is_where_it_was(scene, photos, walk):
    seen = preview_photo(scene, photos[0])
    assert seen.photo == photos[0].name
    assert seen.unseen == ()
    assert len(seen.tape) == len(seen.marks) * (len(seen.marks) - 1) / 2
    assert not any(check.is_off for check in seen.tape)
    np.testing.assert_allclose(seen.robot, walk[0], atol=3e-3)
    assert seen.robot_side_px > 0


def test_a_wrong_tape_is_worst_at_its_marker(scene, photos):
    first, *others = scene.floor.markers
    moved = replace(first, x=first.x + 0.05, y=first.y + 0.02)
    wrong = replace(scene, floor=replace(scene.floor, markers=(moved, *others)))
    worst = max(preview_photo(wrong, photos[0]).tape, key=lambda each: abs(each.seen - each.tape))
    assert worst.is_off
    assert str(first.marker_id) in worst.marks


def test_a_marker_of_another_size_is_said_as_by_a_track(scene, photos):
    assert scene.robot is not None
    assert preview_photo(scene, photos[0]).warnings == ()
    own, prior = scene.robot.marker, replace(scene.prior, mean_height_sd=2e-3, mean_tilt_sd=0.02)
    marker = replace(own, side=1.1 * own.side, side_sd=2e-4)
    robot = replace(scene.robot, marker=marker, prior=prior)
    sound = replace(robot, marker=replace(own, side_sd=2e-4))
    assert preview_photo(replace(scene, robot=sound, prior=prior), photos[0]).warnings == ()
    seen = preview_photo(replace(scene, robot=robot, prior=prior), photos[0])
    (warning,) = seen.warnings
    assert warning.startswith("the side of the robot's marker")


def test_without_a_robot_to_look_for_none_is_found(scene, photos):
    seen = preview_photo(replace(scene, robot=None), photos[0])
    assert (seen.robot, seen.robot_side_px) == (None, None)


def test_a_photograph_that_cannot_be_used_is_named(scene, photos, tmp_path):
    (tmp_path / "empty.jpg").write_bytes(b"")
    with pytest.raises(PhotoError, match=photos[0].name):
        preview_photo(scene, replace(photos[0], path=tmp_path / "empty.jpg"))


def test_marks_are_drawn_and_measured_by_the_lens_that_the_floor_fits(scene, photos):
    lens = scene.camera
    wrong = lens.matrix * [[1.03, 1, 1], [1, 1.03, 1], [1, 1, 1]]
    sd = np.array([*(0.02 * lens.matrix[[0, 1], [0, 1]]), 3.0, 3.0, 0, 0, 0, 0, 0])
    poorly = replace(lens, matrix=wrong, covariance=np.diag(sd**2))
    seen = preview_photo(replace(scene, camera=poorly), photos[0])
    assert abs(seen.camera.matrix[0, 0] / lens.matrix[0, 0] - 1) < 0.025
    assert not any(check.is_off for check in seen.tape)
