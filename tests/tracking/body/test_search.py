# SPDX-License-Identifier: MIT
"""The robot is found by its own picture, and nowhere on an empty floor."""

import numpy as np
import pytest

from support.drawn_plate import LENS, PLATE, PRIOR, VIEW, annotated, picture_of
from tracking.body import find_body, make_template


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
