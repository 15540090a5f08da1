# SPDX-License-Identifier: MIT
"""A floor with four markers, and their projections in a camera."""

import numpy as np

from tracking.camera import Camera, CameraPose, project
from tracking.floor import FloorMap, FloorMarker, FloorView
from tracking.markers import Sighting

LENS = Camera((1280, 960), np.array([[1400.0, 0, 640], [0, 1400, 480], [0, 0, 1]]), np.zeros(5))
FLOOR = FloorMap(
    "4x4_50",
    tuple(
        FloorMarker(number, 0.1, x, y, yaw=0.3 * number)
        for number, (x, y) in enumerate([(0.3, -0.4), (2.0, -0.3), (2.1, 1.7), (-0.2, 1.6)], 10)
    ),
)


SIGMA = 0.05


def camera_pose(x=1.0, y=-1.6, z=2.6, pan=0.0) -> CameraPose:
    eye, target = np.array([x, y, z]), np.array([1.0, 0.7, 0.0])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.vstack((right, np.cross(ahead, right), ahead))
    c, s = np.cos(pan), np.sin(pan)
    rotation = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ rotation
    return CameraPose.from_matrix(rotation, -rotation @ eye)


def see(floor: FloorMap, pose: CameraPose, rng, name="photo.jpg") -> FloorView:
    sightings = [
        Sighting(
            marker.marker_id,
            project(LENS, pose, marker.points) + SIGMA * rng.standard_normal((4, 2)),
            SIGMA**2 * np.eye(8),
            1.0,
            0.7,
        )
        for marker in floor.markers
    ]
    return FloorView.of(name, sightings)
