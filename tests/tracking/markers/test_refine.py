# SPDX-License-Identifier: MIT
"""Corners come from all pixels of a marker, without bias and with their covariance."""

import csv

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_markers import photograph, random_quad
from tracking.markers import find_markers, marker_picture, refine_corners


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


def test_the_covariance_of_corners_holds_for_dark_blurred_compressed_pictures():
    # A fit takes into its corners the part of correlated errors that is most like a moved corner.
    # The covariance of what it leaves was taken for that of the errors: the mean here was 1.47.
    rng, distances = np.random.default_rng(5), []
    for side, blur, noise, quality in ((50, 2.2, 2.0, 75), (35, 1.8, 1.0, 60), (45, 2.5, 0.0, 50)):
        for _ in range(30):
            quad = random_quad(rng, side)
            picture = photograph(quad, rng, blur=blur, noise=noise, contrast=0.3, quality=quality)
            (sighting,) = find_markers(picture, "4x4_50", wanted=[0])
            error = (sighting.corners_px - quad).ravel()
            distances.append(error @ np.linalg.solve(sighting.covariance, error) / 8)
    assert 0.85 < np.mean(distances) < 1.33


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


def test_a_marker_flatter_than_the_largest_lag_has_a_covariance():
    grey = np.full((60, 120), 200, np.uint8)
    quad = np.array([[40.0, 28], [76, 28], [78, 34], [38, 34]])
    flat = cv2.getPerspectiveTransform(
        np.array([[0, 0], [240, 0], [240, 240], [0, 240]], np.float32), quad.astype(np.float32)
    )
    drawn = (255 * marker_picture("4x4_50", 3, 40)[40:-40, 40:-40]).astype(np.uint8)
    grey = cv2.warpPerspective(drawn, flat, (120, 60), grey, borderMode=cv2.BORDER_TRANSPARENT,
                               flags=cv2.INTER_AREA)  # fmt: skip
    found = refine_corners(np.asarray(grey), quad, dictionary="4x4_50", marker_id=3)
    assert found is not None
    assert np.linalg.eigvalsh(found.covariance).min() > 0
