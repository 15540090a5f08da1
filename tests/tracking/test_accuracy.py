# SPDX-License-Identifier: MIT
"""Accuracy and recall on a few simulated photographs; `tests/long` measures them on hundreds."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from support.synthetic import (
    HARSH,
    Conditions,
    DrawnFloorMarker,
    DrawnPose,
    DrawnRobotMarker,
    DrawnScene,
    RobotState,
    look_at,
    render_background,
    take_photo,
)
from tracking.camera import Camera
from tracking.detect import MarkedRobot, RobotMarker, pose_of_marker
from tracking.floor import FloorMap, FloorMarker, FloorView, refine_floor
from tracking.markers import find_markers
from tracking.path import PoseObservation
from tracking.pose import PLANAR, BodyPrior
from tracking.shared import SIDE

PLACES = [(0.1, -0.1), (1.5, -0.1), (1.6, 1.2), (0.0, 1.3)]
GOOD = Conditions(defocus_sd_px=0.6)


@dataclass(frozen=True)
class Case:
    """One row of the table: how the robot moves, how it is photographed, and what is promised."""

    name: str
    conditions: Conditions
    bounce: float
    tilt: float
    xy_mm: float
    yaw_deg: float
    recall: float
    size: tuple[int, int] = (1280, 960)


CASES = [
    Case("steady, 1.3 MP", GOOD, 0.0, 0.0, 0.5, 0.2, 1.0),
    Case("5 mm bounce, 2 degrees tilt, 1.3 MP", GOOD, 5e-3, np.radians(2), 4.0, 0.3, 0.99),
    Case("harsh, 1.3 MP", HARSH, 0.0, 0.0, 1.0, 0.3, 0.9),
]


@cache
def empty_scene(size: tuple[int, int]) -> tuple[DrawnScene, np.ndarray]:
    """Return the scene and its picture without a robot."""
    taken = look_at((0.8, -1.2, 1.8), (0.8, 0.6, 0.0), width=size[0], height=size[1])
    markers = (DrawnFloorMarker(10 + k, place, 0.12) for k, place in enumerate(PLACES))
    scene = DrawnScene(taken, tuple(markers))
    return scene, render_background(scene)


def run(case: Case, count: int, seed: int):
    """Photograph `count` poses; return errors, standardised errors and recall."""
    rng = np.random.default_rng(seed)
    scene, background = empty_scene(case.size)
    taken = scene.camera
    lens = Camera(
        case.size,
        np.array([[taken.focal[0], 0, taken.centre[0]], [0, taken.focal[1], taken.centre[1]],
                  [0, 0, 1.0]]),
        np.array(taken.distortion, dtype=float),
    )  # fmt: skip
    floor = FloorMap("4x4_50", tuple(
        FloorMarker(10 + k, 0.12, *place, position_sd=1e-4) for k, place in enumerate(PLACES)
    ))  # fmt: skip
    mark = DrawnRobotMarker()
    robot = RobotMarker(0, mark.side, "4x4_50", (0.0, 0.0, mark.height))
    prior = BodyPrior(0.0645, max(case.bounce, 5e-4), max(case.tilt, 2e-3))
    marked, errors, z, fit = MarkedRobot(robot, prior), [], [], None
    for index in range(count):
        truth = DrawnPose(
            rng.uniform(0.2, 1.4), rng.uniform(0.1, 1.0), rng.uniform(-np.pi, np.pi),
            0.0645 + rng.normal(0, case.bounce), *rng.normal(0, case.tilt, 2),
        )  # fmt: skip
        photo = take_photo(
            scene, RobotState(truth), conditions=case.conditions, rng=rng, background=background
        )
        if index == 0:
            marks = find_markers(photo.pixels, "4x4_50", wanted=floor.marker_ids)
            fit = refine_floor(lens, floor, [FloorView.of("p", marks)])
        found = find_markers(photo.pixels, "4x4_50", wanted=[0])
        if len(found) != 1:
            continue
        pose = pose_of_marker(fit, fit.stands[0].pose, found[0], marked)
        error = pose.planar - [truth.x, truth.y, truth.yaw]
        error[2] = np.angle(np.exp(1j * error[2]))
        shared = fit.shared.also(SIDE, robot.spreads[SIDE])
        by_error = PoseObservation("p", 0, 0, pose, 1, "marker").by_error(shared, prior)[PLANAR]
        total = pose.planar_covariance + by_error @ shared.covariance @ by_error.T
        errors.append(error)
        z.append(error / np.sqrt(np.diag(total)))
    return np.array(errors), np.array(z), len(errors) / count


def check(case: Case, count: int, seed: int) -> None:
    errors, z, recall = run(case, count, seed)
    xy = 1e3 * np.sqrt(np.mean(np.sum(errors[:, :2] ** 2, axis=1)))
    yaw = np.degrees(np.sqrt(np.mean(errors[:, 2] ** 2)))
    inside = np.mean(np.abs(z) < 1.645, axis=0)
    row = (f"{case.name}: xy {xy:.2f} mm, yaw {yaw:.3f} deg, recall {recall:.0%}, "
           f"90 % intervals hold {inside.round(3)} of x, y, yaw (n = {len(errors)})")  # fmt: skip
    assert xy < case.xy_mm, row
    assert yaw < case.yaw_deg, row
    assert recall >= case.recall, row


@pytest.mark.parametrize("case", CASES[1:], ids=lambda case: case.name)
def test_a_few_simulated_photographs_keep_the_promise(case):
    check(case, 3, seed=0)
