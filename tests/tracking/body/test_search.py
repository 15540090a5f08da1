# SPDX-License-Identifier: MIT
"""The robot is found by its own picture, and nowhere on an empty floor."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_board import composite, likeness
from support.drawn_plate import LENS, PLATE, PRIOR, VIEW, annotated, picture_of
from tracking.body import find_body, make_template
from tracking.body.search import match_whole
from tracking.camera import CameraPose
from tracking.composite.pasted import PastedReading
from tracking.errors import FloorError


@pytest.fixture(scope="module")
def template():
    rng = np.random.default_rng(0)
    return make_template(
        picture_of((0.0, 0.0, 0.4), rng), LENS, VIEW, pose=annotated((0.0, 0.0, 0.4)), plate=PLATE
    )


def test_the_robot_is_found_anywhere_in_any_heading(template):
    rng, errors, z = np.random.default_rng(1), [], []
    for _ in range(3):
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


def test_a_top_beside_the_body_s_origin_is_found_from_there(template):
    planar, beside = np.array([0.2, 0.1, 0.7]), np.array([0.03, 0.12])
    plate = replace(PLATE, centre_x=beside[0], centre_y=beside[1])
    moved = replace(
        template, plate=plate, points_body=template.points_body + np.array([*beside, 0.0])
    )
    picture = picture_of(planar, np.random.default_rng(4))
    found = find_body(picture, LENS, VIEW, template=moved, prior=PRIOR, near=(0.2, 0.1), reach=0.3)
    c, s = np.cos(planar[2]), np.sin(planar[2])
    origin = planar[:2] - np.array([[c, -s], [s, c]]) @ beside
    np.testing.assert_allclose(found.best.pose.planar[:2], origin, atol=2e-3)


def test_an_empty_floor_shows_no_robot(template):
    rng = np.random.default_rng(2)
    empty = picture_of((50.0, 50.0, 0.0), rng)
    assert find_body(empty, LENS, VIEW, template=template, prior=PRIOR, near=(0, 0)) is None


@pytest.mark.parametrize("up", [0.1, 0.6])  # rad: some floor far away is seen, and none
def test_a_camera_that_sees_no_floor_near_it_is_refused_with_what_to_do(up, template):
    c, s = np.cos(up), np.sin(up)
    turn = np.array([[0.0, -1.0, 0.0], [s, 0.0, -c], [c, 0.0, s]])
    view = CameraPose.from_matrix(turn, -turn @ [0.0, 0.0, 0.5])
    picture = np.zeros((480, 640, 3), np.uint8)
    with pytest.raises(FloorError, match=r"0\.50 m high.*within 1\.50 m.*tilt"):
        find_body(picture, LENS, view, template=template, prior=PRIOR)


def test_whole_matches_are_where_the_robot_is_best_first_and_none_is_on_an_empty_floor():
    planar = np.array([0.05, 0.0, 2 * np.pi * 3 / 48])
    known = likeness(composite(planar[None]), planar, reach=0.3)
    template, plane = known.body_template(), PastedReading.of(known, cells=22).plane

    def matches(pixels, least):
        return match_whole(plane.read_smooth(pixels), plane, template=template, least=least)

    found = matches(composite(planar[None], seed=1), 0.5)
    np.testing.assert_allclose(found[0], planar, atol=0.01)
    assert abs(found[0][2] - planar[2]) < 1e-9
    assert matches(composite(np.array([[5.0, 5.0, 0.0]])), 0.6) == []
