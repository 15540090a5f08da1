# SPDX-License-Identifier: MIT
"""The pictures of a track show its path, its marks and its gaps."""

import cv2
import numpy as np
import pytest

from tracking.camera import Camera, CameraPose, project
from tracking.detect import Detection
from tracking.floor import FloorMap, FloorMarker, FloorView
from tracking.markers import Sighting
from tracking.path import PoseObservation, assemble_track
from tracking.pose import BodyPose, BodyPrior
from tracking.shared import SharedErrors
from zebro_lab.track.photographs import PlacedPhoto
from zebro_lab.track.pictures import draw_track, ellipse_90, seen_marks

LENS = Camera((320, 240), np.array([[300.0, 0, 160], [0, 300, 120], [0, 0, 1]]), np.zeros(5))
DOWN = CameraPose.from_matrix(np.diag([1.0, -1.0, -1.0]), np.array([-0.5, 0.3, 2.0]))
PHOTO = PlacedPhoto(np.full((240, 320, 3), 130, np.uint8), LENS, DOWN)
FLOOR = FloorMap("4x4_50", (FloorMarker(10, 0.1, 0.1, 0.1), FloorMarker(11, 0.1, 0.9, 0.5)))


@pytest.fixture
def track():
    """Walk along x, with a pause of a minute in it."""
    times = (0.0, 2.0, 4.0, 6.0, 66.0, 68.0)
    seen = [
        PoseObservation(
            f"p{k}.jpg", t, 0.0,
            BodyPose(np.array([0.2 + 0.1 * k, 0.3, 0.06, 0.0, 0.0, 0.0]), 1e-6 * np.eye(6)), 0.9,
            "marker",
        )
        for k, t in enumerate(times)
    ]  # fmt: skip
    return assemble_track(seen, shared=SharedErrors.none(), prior=BodyPrior(0.06))


def test_three_pictures_are_drawn(track, tmp_path):
    draw_track(
        tmp_path, track, PHOTO, floor=FLOOR, detection=None,
        title="a walk", simulated=True,
    )  # fmt: skip
    for name in ("overlay.png", "map.png", "residuals.png"):
        picture = cv2.imread(str(tmp_path / name))
        assert picture is not None
        assert picture.std() > 5


def test_marks_are_outlined_where_the_map_has_them_and_the_robots_where_it_is_seen():
    alone = seen_marks(PHOTO, FLOOR, None)
    assert [each.labels for each in alone] == [["10", "11"]]
    np.testing.assert_allclose(
        alone[0].outlines_px[0], project(LENS, DOWN, FLOOR.markers[0].points)
    )
    corners = np.array([[10.0, 10], [20, 10], [20, 20], [10, 20]])
    sighting = Sighting(3, corners, np.eye(8), 1.0, 0.7)
    both = seen_marks(PHOTO, FLOOR, Detection("p.jpg", FloorView.of("p.jpg"), sighting))
    assert both[1].labels == ["robot 3"]
    np.testing.assert_array_equal(both[1].outlines_px[0], corners)


def test_the_region_of_ninety_percent_holds_ninety_percent():
    covariance = np.array([[2.0, 0.8], [0.8, 1.0]])
    ring = ellipse_90(covariance)
    distance = np.einsum("ni,ij,nj->n", ring, np.linalg.inv(covariance), ring)
    np.testing.assert_allclose(distance, 4.605, atol=1e-3)
