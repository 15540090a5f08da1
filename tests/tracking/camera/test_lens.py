# SPDX-License-Identifier: MIT
"""Projection, its inverse on a plane and its derivatives agree."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_boards import LENS
from tracking.camera import Camera, CameraPose, project, project_with_derivatives, to_floor


def looking_down(x: float = 1.0, y: float = -1.6, z: float = 2.6) -> CameraPose:
    eye, target = np.array([x, y, z]), np.array([1.0, 0.7, 0.0])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.vstack((right, np.cross(ahead, right), ahead))
    return CameraPose.from_matrix(rotation, -rotation @ eye)


@given(x=st.floats(-0.3, 2.2), y=st.floats(-0.4, 1.8), height=st.floats(0.0, 0.25))
def test_a_plane_comes_back_from_its_own_picture(x, y, height):
    pose = looking_down()
    pixel = project(LENS, pose, [[x, y, height]])
    np.testing.assert_allclose(to_floor(LENS, pose, pixel, height), [[x, y]], atol=1e-5)


def test_a_pixel_above_the_horizon_shows_no_floor():
    straight = Camera(LENS.size, LENS.matrix, np.zeros(5))
    assert np.isnan(to_floor(straight, looking_down(), [[600.0, -4000.0]])).all()


def test_derivatives_agree_with_finite_differences():
    pose, points = looking_down(), np.array([[0.4, 0.3, 0.1], [1.5, 1.0, 0.0]])
    _, by_point, by_pose, by_lens = project_with_derivatives(LENS, pose, points)
    step = 1e-6
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        moved = project(LENS, pose, points + shift) - project(LENS, pose, points - shift)
        np.testing.assert_allclose(by_point[:, :, axis], moved / (2 * step), rtol=1e-4, atol=1e-2)
    for axis in range(6):
        shift = step * np.eye(6)[axis]
        ends = [
            CameraPose(pose.rotation_vector + s * shift[:3], pose.translation + s * shift[3:],
                       pose.covariance)
            for s in (1, -1)
        ]  # fmt: skip
        moved = project(LENS, ends[0], points) - project(LENS, ends[1], points)
        np.testing.assert_allclose(by_pose[:, :, axis], moved / (2 * step), rtol=1e-4, atol=1e-2)
    for axis in range(9):
        shift = step * np.eye(9)[axis]
        moved = project(LENS.changed(shift), pose, points) - project(
            LENS.changed(-shift), pose, points
        )
        np.testing.assert_allclose(by_lens[:, :, axis], moved / (2 * step), rtol=1e-4, atol=1e-4)


def test_a_scaled_lens_is_as_uncertain():
    """Half as large pictures have half the error of focal length, and that of distortion as is."""
    known = replace(LENS, covariance=np.diag(np.arange(1.0, 10.0)))
    half = known.scaled((LENS.size[0] // 2, LENS.size[1] // 2)).covariance
    np.testing.assert_allclose(np.diag(half), [0.25, 0.5, 0.75, 1.0, 5.0, 6.0, 7.0, 8.0, 9.0])


def test_a_scaled_picture_shows_the_same_scene():
    # Pixel (u, v) of the small picture covers the middle of pixels 2u, 2u + 1 of the large one.
    large = LENS.scaled((2560, 1920))
    point = [[0.7, 0.4, 0.1]]
    small_px = project(LENS, looking_down(), point)
    large_px = project(large, looking_down(), point)
    np.testing.assert_allclose((large_px + 0.5) / 2 - 0.5, small_px, atol=1e-9)


def test_a_cropped_picture_is_refused():
    with pytest.raises(ValueError, match="1280x720"):
        LENS.scaled((1280, 720))
