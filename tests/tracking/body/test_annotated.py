# SPDX-License-Identifier: MIT
"""A template that was cut out at a wrong pose errs in all photographs as its derivatives say."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_plate import LENS, PLATE, PRIOR, VIEW, picture_of
from tracking.body import AnnotatedPose, align, make_template
from tracking.camera import project
from tracking.pose import BodyPose, fit_pose, rotation_with_derivatives
from tracking.shared import ANNOTATION, HEIGHT, TILT

STATE = np.array([0.05, -0.02, PRIOR.height, 0.0, 0.0, 0.4])
CORNERS = PLATE.corners_body


def corners_in_photo(state):
    R, _ = rotation_with_derivatives(*state[3:])
    return project(LENS, VIEW, CORNERS @ R.T + state[:3])


def clicked(state, prior=PRIOR, clicks_px=0.0):
    """Fit a pose to clicks on the corners of a robot."""
    pose = fit_pose(
        LENS, VIEW, points_body=CORNERS, corners_px=corners_in_photo(state) + clicks_px,
        covariance=0.25 * np.eye(8), prior=prior,
    )  # fmt: skip
    return AnnotatedPose(LENS, VIEW, pose, prior, CORNERS)


def errors(found, state):
    """Return the true pose less the annotated one, x and y along the body."""
    missed = state - found.pose.state
    c, s = np.cos(found.pose.state[5]), np.sin(found.pose.state[5])
    return np.array([c * missed[0] + s * missed[1], -s * missed[0] + c * missed[1], *missed[2:]])


def test_it_errs_by_the_covariance_of_clicks_and_of_height_and_tilt():
    rng, drawn = np.random.default_rng(1), []
    for _ in range(500):
        state = STATE.copy()
        state[2:5] += rng.multivariate_normal(np.zeros(3), PRIOR.covariance)
        drawn.append(errors(clicked(state, clicks_px=0.5 * rng.standard_normal((4, 2))), state))
    stated = clicked(STATE).covariance
    sd = np.sqrt(np.diag(stated))
    np.testing.assert_allclose(np.std(drawn, axis=0), sd, rtol=0.12)
    np.testing.assert_allclose(
        np.corrcoef(np.transpose(drawn)), stated / np.outer(sd, sd), atol=0.15
    )


def test_it_errs_with_the_means_that_the_prior_assumes():
    base, by_mean = clicked(STATE), clicked(STATE).by_mean
    for k, step in enumerate((2e-3, 5e-3, 5e-3)):
        state = STATE.copy()
        state[2 + k] += step  # the prior stays: its mean is off by the step
        np.testing.assert_allclose(
            errors(clicked(state), state) - errors(base, STATE), by_mean[:, k] * step,
            atol=0.05 * np.abs(by_mean[:, k] * step).max() + 1e-6,
        )  # fmt: skip


@pytest.mark.parametrize("k", range(6))
def test_a_pose_found_with_the_template_is_off_by_its_derivative(k):
    """Templates are cut out at poses that are wrong in one coordinate, and found elsewhere."""
    rng, step = np.random.default_rng(0), [2e-3, 2e-3, 4e-3, 0.03, 0.03, 0.02][k]
    pixels, elsewhere = picture_of(STATE[[0, 1, 5]], rng), np.array([-0.1, 0.06, 1.3])
    photo = picture_of(elsewhere, rng)

    def found(by):
        state = STATE.copy()
        state[k] += by
        pose = BodyPose(state, clicked(STATE).pose.covariance)
        template = make_template(pixels, LENS, VIEW, pose=pose, plate=PLATE, prior=PRIOR)
        seen = align(photo, LENS, VIEW, template=template, prior=PRIOR, start=elsewhere)
        assert seen is not None
        return seen.pose

    high, low = found(step), found(-step)
    error = np.zeros(6)  # true less annotated, from high to low
    error[k] = -2 * step
    c, s = np.cos(STATE[5]), np.sin(STATE[5])
    error[:2] = [[c, s], [-s, c]] @ error[:2]
    # The true pose is the found one plus derivative times error; it does not change.
    expected = -0.5 * (high.by_cause[ANNOTATION] + low.by_cause[ANNOTATION]) @ error
    moved = high.planar - low.planar
    tolerance = 0.15 * np.abs(expected[[0, 1, 5]]).max() + [2e-4, 2e-4, 2e-3]
    assert np.all(np.abs(moved + expected[[0, 1, 5]] * -1) < tolerance), (moved, expected)


def test_shifts_and_turns_are_followed_as_a_whole():
    whole = clicked(STATE).as_a_whole(1.3)
    by = whole[ANNOTATION]
    c, s = np.cos(1.3), np.sin(1.3)
    np.testing.assert_allclose(by[:2, :2], [[c, -s], [s, c]], atol=1e-9)
    assert by[5, 5] == pytest.approx(1.0, abs=0.05)
    assert whole[HEIGHT].shape == (6, 1)
    assert whole[TILT].shape == (6, 2)
    assert np.all(by[2:5] == 0)


def test_a_template_of_unknown_prior_has_no_errors():
    pixels = picture_of(STATE[[0, 1, 5]], np.random.default_rng(0))
    pose = replace(clicked(STATE).pose, state=STATE)
    assert make_template(pixels, LENS, VIEW, pose=pose, plate=PLATE).points_by == {}
