# SPDX-License-Identifier: MIT
"""A short drawn walk in photographs on disk, with what is known of it before looking."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from support.synthetic import (
    DrawnFloorMarker,
    DrawnPose,
    DrawnRobotMarker,
    DrawnScene,
    RobotLook,
    RobotState,
    look_at,
    render_background,
    take_photo,
)
from tracking import MarkedTop, Photo, Scene
from tracking.body import TopPlate
from tracking.camera import Camera, CameraPose, project
from tracking.detect import MarkedRobot, RobotMarker
from tracking.floor import FloorMap, FloorMarker
from tracking.pose import BodyPrior, rotation_with_derivatives

PLACES = ((0.1, -0.1, 0.3), (1.1, -0.1, -0.4), (1.2, 0.8, 0.5), (0.0, 0.9, -0.2))
WALK = ((0.45, 0.2, 0.2), (0.55, 0.23, 0.3), (0.64, 0.27, 0.4))
HEIGHT, SIDE = 0.0645, 0.12
DRAWN = look_at((0.6, -0.9, 1.4), (0.6, 0.35, 0.0), width=800, height=600)


@pytest.fixture(scope="session")
def walk() -> np.ndarray:
    """Return x, y [m] and yaw [rad] of the robot in each photograph."""
    return np.array(WALK)


@pytest.fixture(scope="session")
def photos(tmp_path_factory) -> tuple[Photo, ...]:
    """Photograph a robot with a marker and tail unlike its head."""
    return photographed(tmp_path_factory.mktemp("walk"), RobotLook(DrawnRobotMarker(0, SIDE)))


@pytest.fixture(scope="session")
def plain_photos(tmp_path_factory) -> tuple[Photo, ...]:
    """Photograph a robot without marker, nothing on its top, in the first two places."""
    return photographed(tmp_path_factory.mktemp("plain"), RobotLook(None, parts=0))[:2]


def photographed(folder: Path, look: RobotLook) -> tuple[Photo, ...]:
    """Draw photographs of the walk."""
    rng = np.random.default_rng(0)
    scene = DrawnScene(DRAWN, tuple(
        DrawnFloorMarker(10 + k, (x, y), SIDE, yaw) for k, (x, y, yaw) in enumerate(PLACES)
    ))  # fmt: skip
    background, found = render_background(scene), []
    for number, (x, y, yaw) in enumerate(WALK):
        state = RobotState(DrawnPose(x, y, yaw, HEIGHT))
        picture = take_photo(scene, state, look=look, rng=rng, background=background)
        found.append(Photo(f"p{number}.png", folder / f"p{number}.png"))
        cv2.imwrite(str(found[-1].path), picture.pixels)
    return tuple(found)


@pytest.fixture(scope="session")
def robot() -> MarkedRobot:
    """Return the robot as it was drawn."""
    marker = RobotMarker(0, SIDE, "4x4_50", (0.0, 0.0, DrawnRobotMarker().height))
    return MarkedRobot(marker, BodyPrior(HEIGHT, 5e-4))


@pytest.fixture(scope="session")
def scene(robot) -> Scene:
    """Return what is known of the walk."""
    lens = Camera((DRAWN.width, DRAWN.height), DRAWN.matrix, np.array(DRAWN.distortion))
    markers = (FloorMarker(10 + k, SIDE, x, y, yaw) for k, (x, y, yaw) in enumerate(PLACES))
    return Scene(lens, FloorMap("4x4_50", tuple(markers)), robot.prior, robot)


@pytest.fixture(scope="session")
def top(scene, photos) -> MarkedTop:
    """Click on the corners of the robot's top in the first photograph."""
    plate = TopPlate(0.176, 0.176, 0.0385)
    x, y, yaw = WALK[0]
    view = CameraPose.from_matrix(DRAWN.rotation, DRAWN.translation)
    R, _ = rotation_with_derivatives(0.0, 0.0, yaw)
    corners = project(scene.camera, view, plate.corners_body @ R.T + [x, y, HEIGHT])
    u_v = tuple((float(u), float(v)) for u, v in corners)
    return MarkedTop(photos[0].name, u_v, plate)


@pytest.fixture
def unreadable(tmp_path) -> Photo:
    """Return a file that is no photograph."""
    file: Path = tmp_path / "bad.png"
    file.write_text("no picture")
    return Photo("bad.png", file)
