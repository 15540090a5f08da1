# SPDX-License-Identifier: MIT
"""Markers are found where they were drawn, and no nearer or farther than their error says."""

import csv

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.errors import MarkerError
from tracking.markers import (
    DICTIONARIES,
    Region,
    dictionary_named,
    find_markers,
    guess_dictionary,
    marker_corners,
    marker_picture,
    neighbourhood,
    square_homography,
)
from tracking.markers.square import UNIT_SQUARE, apply_homography

SIZE = 200


def random_quad(rng: np.random.Generator, side: float) -> np.ndarray:
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    flat = (UNIT_SQUARE - 0.5) @ turn.T * [side, 0.75 * side]
    return flat + SIZE / 2 + rng.uniform(-1, 1, 2) + 0.03 * side * rng.uniform(-1, 1, (4, 2))


def photograph(corners, rng, *, blur=0.7, noise=2.0, contrast=0.8, quality=None, number=0):
    """Draw a marker with a white margin at corners whose pixel centres are integers."""
    drawn = marker_picture("4x4_50", number, 32)
    inner = drawn.shape[0] - 64
    own = np.array([[1, 0, 0.5 - 32], [0, 1, 0.5 - 32], [0, 0, inner]]) / inner
    fine = np.array([[6, 0, 2.5], [0, 6, 2.5], [0, 0, 1.0]])
    picture = cv2.warpPerspective(
        drawn * 255, fine @ square_homography(corners) @ own, (6 * SIZE, 6 * SIZE), borderValue=180
    )
    picture = cv2.resize(picture, (SIZE, SIZE), interpolation=cv2.INTER_AREA)
    picture = cv2.GaussianBlur(picture.astype(float), (0, 0), blur) * contrast + 8
    picture += noise * rng.standard_normal(picture.shape)
    grey = np.clip(picture, 0, 255).astype(np.uint8)
    if quality is not None:
        coded = cv2.imencode(".jpg", grey, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
        grey = cv2.imdecode(coded, cv2.IMREAD_GRAYSCALE)
    return grey


@given(seed=st.integers(0, 10_000), side=st.floats(25, 90))
def test_corners_are_found_to_a_few_hundredths_of_a_pixel(seed, side):
    rng = np.random.default_rng(seed)
    quad = random_quad(rng, side)
    (sighting,) = find_markers(photograph(quad, rng), "4x4_50", wanted=[0])
    assert np.abs(sighting.corners_px - quad).max() < 0.15
    assert sighting.score > 0.99


def test_corners_have_no_half_pixel_bias():
    rng = np.random.default_rng(1)
    errors = []
    for _ in range(20):
        quad = random_quad(rng, 50)
        (sighting,) = find_markers(photograph(quad, rng), "4x4_50", wanted=[0])
        errors.append(sighting.corners_px - quad)
    assert np.abs(np.mean(errors, axis=(0, 1))).max() < 0.01


def test_compression_does_not_move_markers_as_a_whole():
    # Pixels thinned out in step with the blocks of JPEG moved these by 0.03 px and said 0.01.
    rng, z = np.random.default_rng(11), []
    for _ in range(25):
        quad = random_quad(rng, 70)
        picture = photograph(quad, rng, blur=1.2, noise=1.0, contrast=0.4, quality=60)
        (sighting,) = find_markers(picture, "4x4_50", wanted=[0])
        shift = (sighting.corners_px - quad).mean(axis=0)
        mean = np.tile(np.eye(2), (1, 4)) / 4
        z.append(shift / np.sqrt(np.diag(mean @ sighting.covariance @ mean.T)))
    assert 0.6 < np.sqrt(np.mean(np.square(z))) < 1.4


def test_dark_blurred_coded_markers_are_found_where_plain_detection_fails():
    rng = np.random.default_rng(2)
    harsh = {"blur": 2.2, "noise": 4.0, "contrast": 0.2, "quality": 75}
    plain, errors = 0, []
    for _ in range(20):
        quad = random_quad(rng, 38)
        picture = photograph(quad, rng, **harsh)
        ids = cv2.aruco.ArucoDetector(dictionary_named("4x4_50")).detectMarkers(picture)[1]
        plain += ids is not None
        errors += [s.corners_px - quad for s in find_markers(picture, "4x4_50", wanted=[0])]
    assert plain <= 10
    assert len(errors) >= 19
    assert np.sqrt(np.mean(np.square(errors))) < 0.25


@pytest.mark.parametrize("contrast", [0.05, 0.15])
def test_dark_markers_are_found_as_bright_ones_are(contrast):
    found = []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        quad = random_quad(rng, 50)
        grey = photograph(quad, rng, blur=2.2, noise=0.7, contrast=contrast)
        found += find_markers(grey, "4x4_50", wanted=[0])
    assert len(found) == 8


def test_the_covariance_of_corners_holds_for_noisy_pictures():
    rng = np.random.default_rng(3)
    distances = []
    for _ in range(25):
        quad = random_quad(rng, 45)
        (sighting,) = find_markers(photograph(quad, rng, noise=8.0), "4x4_50", wanted=[0])
        error = (sighting.corners_px - quad).ravel()
        distances.append(error @ np.linalg.solve(sighting.covariance, error) / 8)
    # Not too small, and too large by no more than what a real print is given for its faults.
    assert 0.25 < np.mean(distances) < 1.3


def test_a_marker_that_is_not_wanted_is_not_found():
    rng = np.random.default_rng(4)
    picture = photograph(random_quad(rng, 60), rng, number=7)
    assert find_markers(picture, "4x4_50", wanted=[0, 1, 2]) == ()
    assert [s.marker_id for s in find_markers(picture, "4x4_50", wanted=range(50))] == [7]


@pytest.mark.parametrize("number", [7, 12, 22, 38, 43])
def test_another_marker_of_the_dictionary_is_not_taken_for_the_one_wanted(number):
    rng = np.random.default_rng([number, 0])
    quad = random_quad(rng, 70)
    grey = photograph(quad, rng, blur=2.2, contrast=0.1, quality=75, number=number)
    assert find_markers(grey, "4x4_50", wanted=[0]) == ()
    assert len(find_markers(grey, "4x4_50", wanted=[number])) == 1


def test_floor_texture_holds_no_marker():
    rng = np.random.default_rng(5)
    texture = cv2.GaussianBlur(rng.uniform(0, 255, (300, 300)).astype(np.float32), (0, 0), 3)
    grey = cv2.normalize(texture, None, 0, 255, cv2.NORM_MINMAX).astype(np.uint8)
    assert find_markers(grey, "4x4_50", wanted=range(10)) == ()


def test_a_region_gives_the_corners_of_the_whole_picture():
    rng = np.random.default_rng(6)
    quad = random_quad(rng, 50)
    picture = photograph(quad, rng)
    (whole,) = find_markers(picture, "4x4_50", wanted=[0])
    region = neighbourhood(whole.corners_px, (SIZE, SIZE), reach=30)
    (part,) = find_markers(picture, "4x4_50", wanted=[0], region=region)
    np.testing.assert_allclose(part.corners_px, whole.corners_px, atol=0.01)


def test_a_region_too_small_for_a_marker_is_empty():
    picture = np.zeros((100, 100), np.uint8)
    assert find_markers(picture, "4x4_50", wanted=[0], region=Region(0, 0, 8, 8)) == ()


def test_the_family_of_markers_is_guessed_for_the_message():
    sheet = np.full((300, 500), 255, np.uint8)
    for index in range(3):
        family = dictionary_named("6x6_250")
        sheet[80:200, 20 + 160 * index : 140 + 160 * index] = cv2.aruco.generateImageMarker(
            family, index, 120
        )
    assert guess_dictionary(sheet) == "6x6_250"
    assert guess_dictionary(np.full((300, 300), 255, np.uint8)) is None


def test_a_misspelt_dictionary_is_named_with_the_nearest():
    with pytest.raises(MarkerError, match="apriltag_36h11"):
        dictionary_named("apriltag36h11")


def test_names_of_dictionaries_are_opencvs_without_the_prefix():
    assert {"4x4_50", "6x6_250", "apriltag_36h11"} <= set(DICTIONARIES)
    assert dictionary_named("DICT_4X4_50").markerSize == 4


def test_a_marker_on_the_floor_has_opencvs_corner_order():
    expected = [[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, -0.5, 0]]
    np.testing.assert_allclose(marker_corners(1.0), expected)
    ahead = marker_corners(1.0, yaw=-np.pi / 2)
    np.testing.assert_allclose(ahead[0], [0.5, 0.5, 0], atol=1e-12)


@given(st.lists(st.floats(-0.2, 0.2), min_size=8, max_size=8))
def test_the_homography_of_a_square_takes_its_corners_there(shifts):
    corners = UNIT_SQUARE + np.reshape(shifts, (4, 2))
    H = square_homography(corners)
    np.testing.assert_allclose(apply_homography(H, UNIT_SQUARE), corners, atol=1e-9)


@pytest.mark.reference
@pytest.mark.parametrize(
    ("name", "dictionary"),
    [
        ("singlemarkersoriginal.jpg", "6x6_250"),
        ("choriginal.jpg", "6x6_250"),
        ("gboriginal.png", "tutorial_dict.yml"),
    ],
)
def test_real_photographs_give_the_gold_corners(shared, name, dictionary):
    folder = shared / "realdata/aruco-photos"
    if dictionary.endswith("yml"):
        dictionary = str(folder / dictionary)
    with (folder / f"gold_{name.split('.')[0]}.csv").open(encoding="utf-8") as file:
        gold = {
            int(row[0]): np.reshape([float(x) for x in row[1:]], (4, 2))
            for row in list(csv.reader(file))[1:]
        }
    picture = cv2.imread(str(folder / name))
    plain = find_markers(picture, dictionary, wanted=gold, effort=0)
    fitted = find_markers(picture, dictionary, wanted=gold)
    assert [s.marker_id for s in plain] == [s.marker_id for s in fitted] == sorted(gold)
    assert max(np.abs(s.corners_px - gold[s.marker_id]).max() for s in plain) <= 1.0
    # Gold corners are whole pixels, the last black ones; fitted corners are the edge of the black,
    # half a pixel outside.
    inset = [_inset(s.corners_px, 0.5) - gold[s.marker_id] for s in fitted]
    assert np.sqrt(np.mean(np.square(inset))) <= 0.5


def _inset(corners, width):
    """Move every side of a quadrilateral inward."""
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack((-sides[:, 1], sides[:, 0])) / np.linalg.norm(sides, axis=1)[:, None]
    offsets = np.einsum("ia,ia->i", normals, corners) + width
    pairs = [((i - 1) % 4, i) for i in range(4)]
    return np.array([np.linalg.solve(normals[list(p)], offsets[list(p)]) for p in pairs])
