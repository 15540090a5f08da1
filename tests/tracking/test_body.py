# SPDX-License-Identifier: MIT
"""The robot's own picture is found again; head and tail are told apart or refused."""

import cv2
import numpy as np
import pytest

from tracking.body import (
    Alignment,
    BodyCandidates,
    TopPlate,
    find_body,
    make_template,
    resolve_headings,
)
from tracking.camera import Camera, CameraPose, project
from tracking.errors import AmbiguousHeading, BodyError
from tracking.pose import BodyPose, BodyPrior, fit_pose, rotation_with_derivatives

LENS = Camera((640, 480), np.array([[700.0, 0, 320], [0, 700, 240], [0, 0, 1]]), np.zeros(5))
_TURN = np.linalg.svd([[1.0, 0, 0], [0, -0.85, -0.53], [0, 0.53, -0.85]])
VIEW = CameraPose.from_matrix(_TURN[0] @ _TURN[2], [0.0, 0.2, 2.0])
PLATE = TopPlate(0.24, 0.16, 0.03, margin=0.01, front_margin=0.01)
PRIOR = BodyPrior(0.1)


def picture_of(planar, rng, *, noise=2.0):
    """Draw a plate with a bright stripe at its head on a wooden floor, by inverse mapping."""
    u, v = np.meshgrid(np.arange(640.0), np.arange(480.0))
    ground = _on_plane(u, v, 0.0)
    top = _on_plane(u, v, PRIOR.height + PLATE.height)
    shade = 120 + 10 * np.sin(40 * ground[1]) + 6 * np.sin(9 * ground[0] + 20 * ground[1])
    picture = np.stack((0.7 * shade, shade, 1.2 * shade), axis=-1)
    c, s = np.cos(planar[2]), np.sin(planar[2])
    dx, dy = top[0] - planar[0], top[1] - planar[1]
    x, y = c * dx + s * dy, -s * dx + c * dy
    picture[(np.abs(x) < 0.12) & (np.abs(y) < 0.08)] = (150, 70, 30)
    picture[(np.abs(x - 0.09) < 0.015) & (np.abs(y) < 0.06)] = (220, 220, 230)
    picture[(np.abs(x + 0.03) < 0.02) & (np.abs(y - 0.03) < 0.02)] = (40, 40, 200)
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8) + noise * rng.standard_normal(picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def _on_plane(u, v, height):
    ahead = np.stack(((u - 320) / 700, (v - 240) / 700, np.ones_like(u)), axis=-1) @ VIEW.rotation
    eye = VIEW.position
    reach = (height - eye[2]) / ahead[..., 2]
    return eye[0] + reach * ahead[..., 0], eye[1] + reach * ahead[..., 1]


def annotated(planar):
    state = np.array([planar[0], planar[1], PRIOR.height, 0, 0, planar[2]])
    R, _ = rotation_with_derivatives(0, 0, planar[2])
    corners = project(LENS, VIEW, PLATE.corners_body @ R.T + state[:3])
    return fit_pose(
        LENS, VIEW, points_body=PLATE.corners_body, corners_px=corners,
        covariance=0.1 * np.eye(8), prior=PRIOR,
    )  # fmt: skip


@pytest.fixture(scope="module")
def template():
    rng = np.random.default_rng(0)
    return make_template(
        picture_of((0.0, 0.0, 0.4), rng), LENS, VIEW, pose=annotated((0.0, 0.0, 0.4)), plate=PLATE
    )


def test_the_robot_is_found_anywhere_in_any_heading(template):
    rng, errors, z = np.random.default_rng(1), [], []
    for _ in range(4):
        planar = np.array([rng.uniform(-0.4, 0.4), rng.uniform(-0.3, 0.5), rng.uniform(-3, 3)])
        found = find_body(
            picture_of(planar, rng), LENS, VIEW, template=template, prior=PRIOR, near=planar[:2],
            reach=0.2,
        )  # fmt: skip
        pose = found.best.pose
        error = pose.planar - planar
        error[2] = np.angle(np.exp(1j * error[2]))
        errors.append(error)
        z.append(error / np.sqrt(np.diag(pose.planar_covariance)))
    assert np.abs(errors)[:, :2].max() < 2e-3
    assert np.degrees(np.abs(errors)[:, 2].max()) < 1.0
    assert np.sqrt(np.mean(np.square(z))) < 1.5


def test_an_empty_floor_shows_no_robot(template):
    rng = np.random.default_rng(2)
    empty = picture_of((50.0, 50.0, 0.0), rng)
    assert find_body(empty, LENS, VIEW, template=template, prior=PRIOR, near=(0, 0)) is None


def test_a_robot_cut_by_the_edge_is_no_template():
    rng = np.random.default_rng(3)
    with pytest.raises(BodyError, match="cut by the edge"):
        make_template(
            picture_of((1.0, 0.0, 0.0), rng), LENS, VIEW, pose=annotated((1.0, 0.0, 0.0)),
            plate=PLATE,
        )  # fmt: skip


def test_a_picture_without_contrast_is_no_template():
    with pytest.raises(BodyError, match="grey levels"):
        make_template(
            np.full((480, 640, 3), 90, np.uint8), LENS, VIEW, pose=annotated((0, 0, 0)), plate=PLATE
        )


def test_a_plate_without_sides_is_refused():
    with pytest.raises(BodyError, match="positive sides"):
        TopPlate(0.2, 0.0, 0.03)


def reading(x, yaw, likelihood=0.0, y=0.0):
    state = np.array([x, y, 0.1, 0, 0, yaw])
    return Alignment(BodyPose(state, np.eye(6), np.eye(6), 0.0, 0.0), 0.9, likelihood)


def sequence(evidence, step=0.1):
    """A walk along x; `evidence` is how much each photograph prefers the right heading."""
    return [
        BodyCandidates(
            tuple(
                sorted(
                    (reading(step * k, 0.02 * k, e), reading(step * k, 0.02 * k + np.pi)),
                    key=lambda option: -option.log_likelihood,
                )
            )
        )
        for k, e in enumerate(evidence)
    ]


def test_one_photograph_that_is_wrong_is_outvoted_by_the_others():
    chosen = resolve_headings(sequence([3, 4, -5, 3, 4]), length=0.2, walks_ahead=False)
    assert all(np.cos(alignment.pose.state[5]) > 0 for alignment in chosen)


def test_a_walk_tells_head_from_tail_without_any_picture():
    chosen = resolve_headings(sequence([0.0] * 6), length=0.2)
    assert all(np.cos(alignment.pose.state[5]) > 0 for alignment in chosen)


def test_a_robot_alike_at_both_ends_that_stands_still_is_refused():
    with pytest.raises(AmbiguousHeading, match="1000 to 1") as caught:
        resolve_headings(sequence([0.1] * 6, step=0.0), length=0.2)
    assert caught.value.odds < 1000


def test_no_flip_in_a_thousand_sequences():
    rng = np.random.default_rng(4)
    for _ in range(1000):
        chosen = resolve_headings(sequence(rng.normal(0.5, 3.0, 8)), length=0.2)
        assert all(np.cos(alignment.pose.state[5]) > 0 for alignment in chosen)
