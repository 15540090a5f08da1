# SPDX-License-Identifier: MIT
"""Two detectors that count pixels differently agree on where a tag is."""

import sys

import cv2
import numpy as np
import pytest

from tracking.markers import apriltags, dictionary_named, find_markers
from tracking.markers.apriltags import FAMILIES, apriltag_quads


def picture(dictionary: str, number: int, *, side: float = 90.0, turn: float = 0.3):
    """Draw a tag turned, in perspective and a little blurred; return it and its true corners."""
    tag = cv2.aruco.generateImageMarker(dictionary_named(dictionary), number, 400)
    sheet = np.pad(tag, 50, constant_values=255)
    inner = np.array([[49.5, 49.5], [449.5, 49.5], [449.5, 449.5], [49.5, 449.5]])
    unit = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * side / 2
    cos, sin = np.cos(turn), np.sin(turn)
    corners = unit @ np.array([[cos, sin], [-sin, cos]]) * [1.0, 0.7] + [161.3, 118.8]
    H = cv2.getPerspectiveTransform(inner.astype(np.float32), corners.astype(np.float32))
    fine = np.diag([4.0, 4.0, 1.0]) @ np.array([[1, 0, 0.375], [0, 1, 0.375], [0, 0, 1.0]]) @ H
    large = cv2.warpPerspective(sheet, fine, (1280, 960), borderValue=255)
    small = cv2.resize(large, (320, 240), interpolation=cv2.INTER_AREA)
    return cv2.GaussianBlur(small, (0, 0), 0.8), corners


@pytest.mark.parametrize("dictionary", FAMILIES)
@pytest.mark.parametrize("turn", [0.3, 2.0, -1.2, 3.1])
def test_both_detectors_have_the_same_corners_in_the_same_order(dictionary, turn):
    grey, true = picture(dictionary, 7, turn=turn)
    [(quad, number)] = apriltag_quads(grey, dictionary, [7])
    assert number == 7
    np.testing.assert_allclose(quad, true, atol=0.25)
    assert np.abs((quad - true).mean(axis=0)).max() < 0.05  # half a pixel would be 0.5
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.ArucoDetector(dictionary_named(dictionary), parameters)
    corners, ids, _ = detector.detectMarkers(grey)
    assert np.ravel(ids).tolist() == [7]
    np.testing.assert_allclose(quad, corners[0][0], atol=0.5)


def test_a_tag_that_opencv_lets_go_of_is_found_where_it_is(monkeypatch):
    grey, true = picture("apriltag_36h11", 7, side=26.0)
    noise = np.random.default_rng(0).normal(0, 2, grey.shape)
    grey = (60 + (grey.astype(float) - 128) / 16 + noise).astype(np.uint8)  # in deep shade
    detector = cv2.aruco.ArucoDetector(dictionary_named("apriltag_36h11"))
    assert detector.detectMarkers(grey)[1] is None
    [sighting] = find_markers(grey, "apriltag_36h11", wanted=[7], effort=1)
    np.testing.assert_allclose(sighting.corners_px, true, atol=0.3)
    monkeypatch.setattr("tracking.markers.find.apriltag_quads", lambda *_: [])
    assert find_markers(grey, "apriltag_36h11", wanted=[7], effort=1) == ()


def test_others_than_those_wanted_and_unknown_families_are_not_sought():
    grey, _ = picture("apriltag_36h11", 7)
    assert apriltag_quads(grey, "apriltag_36h11", [8]) == []
    assert apriltag_quads(grey, "apriltag_36h10", [7]) == []
    assert apriltag_quads(grey, "4x4_50", [7]) == []


def test_opencv_does_without_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "pupil_apriltags", None)
    monkeypatch.setattr(apriltags, "_detector", apriltags._detector.__wrapped__)
    grey, true = picture("apriltag_36h11", 7)
    assert apriltags.apriltag_quads(grey, "apriltag_36h11", [7]) == []
    [sighting] = find_markers(grey, "apriltag_36h11", wanted=[7])
    np.testing.assert_allclose(sighting.corners_px, true, atol=0.1)
