# SPDX-License-Identifier: MIT
"""A top fainter than the floor's grain is aligned, with its error."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from support.drawn_grain import WIDTH, grain
from tracking.body import BodyTemplate, TopPlate
from tracking.camera import Camera, CameraPose
from tracking.composite.floor_pattern import FloorPattern
from tracking.composite.known import KnownExposure
from tracking.composite.pattern_alignment import AROUND, PatternAlignment
from tracking.pose import BodyPose, BodyPrior

LENS = Camera((480, 400), np.array([[900.0, 0, 240], [0, 900, 200], [0, 0, 1]]), np.zeros(5))
VIEW = CameraPose.from_matrix(np.diag([1.0, -1.0, -1.0]), [0.0, 0.0, 1.2])
PLATE = TopPlate(0.1, 0.1, 0.02)
PRIOR = BodyPrior(0.05, 1e-3, 5e-3)
ONE = np.pad(np.ones((3, 1, 1), np.float32), ((0, 0), (3, 3), (3, 3)))
AS_IT_IS = FloorPattern(WIDTH, ONE)  # foretells nothing


def known_exposure(planar, picture):
    state = np.array([planar[0], planar[1], PRIOR.height, 0, 0, planar[2]])
    pose = BodyPose(state, np.zeros((6, 6)))
    nothing = np.zeros(picture.shape[:2], bool)
    area = np.array([-0.2, -0.2]), np.array([0.2, 0.2])
    pixels = np.clip(picture + 128, 0, 255).astype(np.uint8)
    return KnownExposure(pixels, LENS, VIEW, PRIOR, pose, PLATE, (0.1, 0.1), nothing, area)


def plain_top(strength):
    """Draw a plain square top with what is around it; one point a millimetre, flat."""
    half = 0.5 * PLATE.length * (1 + 2 * AROUND)
    x = np.arange(half, -half, -1e-3)
    points = np.stack(np.broadcast_arrays(x[:, None], x[None], PLATE.height), axis=-1)
    inside = (np.abs(points[..., :2]) < 0.5 * PLATE.length).all(axis=-1)
    colours = np.repeat(inside[..., None], 3, axis=2).astype(np.float32) * strength
    return BodyTemplate(PLATE, 1e-3, points, cv2.GaussianBlur(colours, (0, 0), 1.0))


def with_top(picture, template, planar):
    """Lay the top on a picture."""
    exposure = known_exposure(planar, picture)
    job = PatternAlignment(exposure, picture, template, AS_IT_IS, np.array(planar))
    laid = picture.copy()
    laid[job.window[0]] += job.drawn(job.body_at(np.array(planar)))
    return laid


def errors_of_faint_tops(pattern, count=12):
    """Align plain tops half as strong as the floor's grain; how far off they end [m, rad]."""
    template, off = plain_top(strength=5.0), []
    for seed in range(count):
        rng = np.random.default_rng((4, seed))
        true = np.array([*rng.uniform(-0.03, 0.03, 2), rng.uniform(-1, 1)])
        picture = AS_IT_IS.flat(with_top(grain(rng), template, true))
        start = true + rng.normal(0, [1e-3, 1e-3, 0.01])
        exposure = known_exposure(start, picture)
        found = PatternAlignment(exposure, picture, template, pattern, start).solved()
        off.append((found.pose.planar - true, np.sqrt(np.diag(found.pose.planar_covariance))))
    return np.array(off)


def test_a_plain_top_fainter_than_the_grain_is_found_and_its_error_is_as_stated():
    floor = grain(np.random.default_rng(5))
    pattern = FloorPattern.of(floor, np.ones(floor.shape[:2], bool), width=WIDTH)
    white, coloured = errors_of_faint_tops(pattern), errors_of_faint_tops(AS_IT_IS)
    rms = np.sqrt((white[:, 0] ** 2).mean(axis=0))
    assert rms[:2].max() < 5e-4
    assert rms[2] < np.radians(0.5)
    assert rms[:2].max() < 0.5 * np.sqrt((coloured[:, 0] ** 2).mean(axis=0))[:2].max()
    assert 0.3 < np.sqrt(np.mean((white[:, 0] / white[:, 1]) ** 2)) < 2.0


def test_what_is_not_known_of_height_is_in_the_covariance_of_the_place():
    template, planar = plain_top(strength=1.0), np.array([0.1, 0.0, 0.0])
    noise = np.random.default_rng(6).normal(0, 1, template.colours.shape).astype(np.float32)
    template = replace(template, colours=100 * cv2.GaussianBlur(noise, (0, 0), 4))
    picture = with_top(np.zeros((400, 480, 3), np.float32), template, planar)
    found = PatternAlignment(known_exposure(planar, picture), picture, template, AS_IT_IS, planar)
    covariance = found.solved().pose.covariance
    assert covariance[2, 2] == pytest.approx(PRIOR.height_sd**2)
    # A top nearer to the camera by dz shows where one x / distance dz farther out would.
    follows = covariance[0, 2] / covariance[2, 2]
    assert follows == pytest.approx(-planar[0] / (1.2 - PRIOR.height - PLATE.height), rel=0.1)


def test_a_top_that_is_hidden_is_not_aligned():
    template, planar = plain_top(strength=5.0), np.array([0.0, 0.0, 0.0])
    picture = with_top(np.zeros((400, 480, 3), np.float32), template, planar)
    hidden = replace(known_exposure(planar, picture), hidden=np.ones(picture.shape[:2], bool))
    assert PatternAlignment(hidden, picture, template, AS_IT_IS, planar).solved() is None
