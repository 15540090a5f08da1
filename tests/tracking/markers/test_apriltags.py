# SPDX-License-Identifier: MIT
"""Two detectors that count pixels differently agree on where a tag is."""

import re
import sys

import cv2
import numpy as np
import pytest

from tracking.errors import MarkerError
from tracking.markers import dictionary_named, find_markers, marker_family
from tracking.markers.apriltags import FAMILIES, STANDARD, apriltag_quads, tag_family


def picture(dictionary: str, number: int, *, side: float = 90.0, turn: float = 0.3):
    """Draw a tag turned, in perspective and a little blurred; return it and its true corners."""
    tag = cv2.aruco.generateImageMarker(dictionary_named(dictionary), number, 400)
    return photographed(np.pad(tag, 50, constant_values=255), side, turn)


def photographed(sheet, side, turn, margin=50):
    """Photograph a sheet with a square of 400 px, `margin` px from its edges."""
    near, far = margin - 0.5, margin + 399.5
    inner = np.array([[near, near], [far, near], [far, far], [near, far]])
    unit = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * side / 2
    cos, sin = np.cos(turn), np.sin(turn)
    corners = unit @ np.array([[cos, sin], [-sin, cos]]) * [1.0, 0.7] + [161.3, 118.8]
    H = cv2.getPerspectiveTransform(inner.astype(np.float32), corners.astype(np.float32))
    fine = np.diag([4.0, 4.0, 1.0]) @ np.array([[1, 0, 0.375], [0, 1, 0.375], [0, 0, 1.0]]) @ H
    large = cv2.warpPerspective(sheet, fine, (1280, 960), borderValue=255)
    small = cv2.resize(large, (320, 240), interpolation=cv2.INTER_AREA)
    return cv2.GaussianBlur(small, (0, 0), 0.8), corners


@pytest.mark.parametrize("dictionary", sorted(set(FAMILIES) - set(STANDARD)))
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


@pytest.fixture
def without_package(monkeypatch):
    """Make pupil-apriltags seem not installed."""
    monkeypatch.setitem(sys.modules, "pupil_apriltags", None)
    for cached in (tag_family, marker_family):
        cached.cache_clear()
    yield
    for cached in (tag_family, marker_family):
        cached.cache_clear()


@pytest.mark.usefixtures("without_package")
def test_opencv_does_without_the_package():
    grey, true = picture("apriltag_36h11", 7)
    assert apriltag_quads(grey, "apriltag_36h11", [7]) == []
    [sighting] = find_markers(grey, "apriltag_36h11", wanted=[7])
    np.testing.assert_allclose(sighting.corners_px, true, atol=0.1)


@pytest.mark.usefixtures("without_package")
def test_a_family_that_needs_the_package_says_so():
    with pytest.raises(MarkerError, match=r"needs the package pupil-apriltags.*apriltag"):
        find_markers(np.zeros((99, 99), np.uint8), "apriltag_41h12", wanted=[0])


@pytest.mark.parametrize(
    ("dictionary", "count"), [("apriltag_41h12", 2115), ("apriltag_52h13", 48714)]
)
@pytest.mark.parametrize("turn", [0.3, 2.0, -1.2])
def test_standard_tags_are_found_to_a_hundredth_of_their_side(dictionary, count, turn):
    family = marker_family(dictionary)
    assert family.count == count
    cells = drawn_whole(dictionary, 7)
    border = len(cells) - 4
    sheet = np.kron(cells, np.ones((60, 60)))
    sheet = cv2.resize(sheet, None, fx=400 / (60 * border), fy=400 / (60 * border),
                       interpolation=cv2.INTER_AREA)  # fmt: skip
    margin = (len(sheet) - 400) // 2
    grey, true = photographed((255 * sheet).astype(np.uint8), 60.0, turn, margin)
    [plain] = find_markers(grey, dictionary, wanted=range(20), effort=0)
    assert plain.marker_id == 7
    np.testing.assert_allclose(plain.corners_px, true, atol=0.6)
    [sighting] = find_markers(grey, dictionary, wanted=[7])
    assert sighting.score > 0.9
    np.testing.assert_allclose(sighting.corners_px, true, atol=0.15)
    assert find_markers(grey, dictionary, wanted=[8]) == ()


def drawn_whole(dictionary, number):
    """Draw a standard tag with the ring of its code's cells, as its makers publish it."""
    family = tag_family(dictionary)
    whole = np.zeros((family.cells + 4, family.cells + 4))
    whole[2:-2, 2:-2] = 1
    whole[3:-3, 3:-3] = 0
    for k, (row, column) in enumerate(family.places):
        whole[row + 2, column + 2] = int(family.codes[number]) >> (len(family.places) - 1 - k) & 1
    return whole


@pytest.mark.reference
def test_tags_of_a_real_arena_are_found_as_by_their_makers(shared):
    """Several tags of number 0 in each photograph; corners by the makers' own detector."""
    found, asked, apart = 0, 0, []
    for file in sorted((shared / "realdata" / "apriltag-photos").glob("*.txt")):
        lines = file.read_text().strip().splitlines()
        theirs = [np.array(re.findall(r"-?\d+\.\d+", line), float).reshape(4, 2) - 0.5
                  for line in lines]  # fmt: skip
        pixels = cv2.imread(str(file.with_suffix(".jpg")))
        seen = find_markers(pixels, "apriltag_36h11", wanted=[0], several=True)
        asked += len(theirs)
        for corners in theirs:
            gaps = [nearest(each.corners_px, corners) for each in seen]
            best = min(gaps, key=lambda gap: np.abs(gap).max(), default=np.full((4, 2), np.inf))
            if np.abs(best).max() < 5:
                found += 1
                apart.append(best)
    rms = float(np.sqrt(np.mean(np.square(apart))))
    assert found == asked
    assert rms < 0.5, rms


def nearest(ours, theirs):
    """Return the differences of corners, in the order in which they are least."""
    orders = [np.roll(theirs[::way], turn, axis=0) for way in (1, -1) for turn in range(4)]
    return min((ours - order for order in orders), key=lambda gap: np.abs(gap).max())
