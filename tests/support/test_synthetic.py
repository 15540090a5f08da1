# SPDX-License-Identifier: MIT
import ast
import io
from dataclasses import replace
from datetime import datetime, timedelta, timezone
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from PIL import Image
from PIL.ExifTags import IFD, Base

from support.synthetic import (
    IDEAL,
    Conditions,
    DrawnFloorMarker,
    DrawnPose,
    DrawnScene,
    Light,
    RobotState,
    Sheet,
    develop,
    look_at,
    marker_cells,
    paint_sheets,
    render_background,
    take_photo,
    with_time_stamp,
)
from support.synthetic.patterns import INK, PAPER
from support.synthetic.surfaces import half_circle_hit

DISTORTION = (-0.2, 0.05, 0.001, -0.0015, 0.01)
CAMERA = look_at((0.6, -0.9, 1.2), (0.3, 0.2, 0.0), width=480, height=360, distortion=DISTORTION)
SCENE = DrawnScene(
    CAMERA, (DrawnFloorMarker(10, (0.0, 0.0), 0.1), DrawnFloorMarker(11, (0.6, 0.4), 0.1, 0.7))
)
STATE = RobotState(DrawnPose(0.3, 0.15, 0.5, 0.065, 0.03, -0.02))
FLAT_LIGHT = Light(ambient=1.0, lamp=0.0)


@pytest.fixture(scope="module")
def background():
    return render_background(SCENE)


@pytest.fixture(scope="module")
def photo(background):
    return take_photo(SCENE, STATE, rng=np.random.default_rng(0), background=background)


def outline_moments(polygon):
    """Area and centroid of a closed polygon, shape (n, 2)."""
    x, y = polygon.T
    cross = x * np.roll(y, -1) - y * np.roll(x, -1)
    area = cross.sum() / 2
    centroid = [((c + np.roll(c, -1)) * cross).sum() / (6 * area) for c in (x, y)]
    return abs(area), np.array(centroid)


def white_quad(sheet):
    """Draw a sheet alone, in even light, on black."""
    black = np.zeros((CAMERA.height, CAMERA.width, 3), np.float32)
    return paint_sheets(black, [sheet], camera=CAMERA, light=FLAT_LIGHT)[..., 0]


# the lens


@settings(max_examples=50)
@given(
    st.lists(st.floats(-2, 3), min_size=3, max_size=3),
    st.floats(-0.25, 0.1), st.floats(-0.02, 0.05), st.floats(-0.003, 0.003),
)  # fmt: skip
def test_projection_is_that_of_opencv(point, k1, k2, p1):
    camera = replace(CAMERA, distortion=(k1, k2, p1, -p1, 0.01))
    if (camera.rotation @ point + camera.translation)[2] < 0.3:
        return
    rotation, _ = cv2.Rodrigues(camera.rotation)
    expected, _ = cv2.projectPoints(
        np.array([point]), rotation, camera.translation, camera.matrix,
        np.array(camera.distortion),
    )  # fmt: skip
    np.testing.assert_allclose(camera.project(point), expected[0, 0], rtol=1e-9, atol=1e-8)


@settings(max_examples=50)
@given(st.floats(0, 479), st.floats(0, 359), st.floats(0.2, 5.0))
def test_a_ray_leads_back_to_its_pixel(u, v, distance):
    seen = distance * CAMERA.rays((u, v))
    point = CAMERA.rotation.T @ (seen - CAMERA.translation)
    np.testing.assert_allclose(CAMERA.project(point), (u, v), atol=1e-7)


# sub-pixel geometry

ROUGH = 0.017  # standard deviation of how far an edge is misplaced in each pixel [px]


@settings(max_examples=15)
@given(
    st.floats(0.1, 0.5), st.floats(0.0, 0.4), st.floats(0.0, 0.08), st.floats(-np.pi, np.pi),
    st.floats(-0.4, 0.4),
)  # fmt: skip
# Along the rows of three of the lattices: with one lattice in all pixels, 7 to 12 deviations off.
@example(0.4375, 0.1875, 0.0, 1.874, 0.0)
@example(0.4375, 0.1875, 0.0, 3.0381, 0.0)
@example(0.4375, 0.1875, 0.0, 0.374, 0.0)
def test_a_prints_area_and_centroid_are_those_of_its_projected_outline(x, y, z, yaw, tilt):
    rotation = DrawnPose(0, 0, yaw, 0, tilt, -tilt).rotation
    sheet = Sheet(np.ones((1, 1), np.float32), (0.11, 0.07), np.array([x, y, z]), rotation)
    along, one = np.linspace(-0.5, 0.5, 200, endpoint=False), np.ones(200)
    edges = [(along, -0.5 * one), (0.5 * one, along), (-along, 0.5 * one), (-0.5 * one, -along)]
    across, up = (np.concatenate(part) for part in zip(*edges, strict=True))
    polygon = CAMERA.project(sheet.at(0.11 * across, 0.07 * up))
    area, centroid = outline_moments(polygon)
    drawn = white_quad(sheet)
    v, u = np.indices(drawn.shape)
    share = drawn.sum()
    length = np.linalg.norm(np.roll(polygon, -1, axis=0) - polygon, axis=1)
    lever = np.sqrt(length @ (polygon - centroid) ** 2)
    assert share == pytest.approx(area, abs=4 * ROUGH * np.sqrt(length.sum()))
    error = np.array([(u * drawn).sum(), (v * drawn).sum()]) / share - centroid
    assert (np.abs(error) < 4 * ROUGH * lever / area).all()


# patterns


def test_marker_cells_are_those_of_the_dictionary():
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_100)
    bits = cv2.aruco.generateImageMarker(dictionary, 42, 7)
    cells = marker_cells(42, dictionary="DICT_5X5_100", quiet=2)
    np.testing.assert_array_equal(cells[2:-2, 2:-2] > 0.5, bits > 127)
    assert (cells[:2] == np.float32(PAPER)).all()
    assert cells.min() == np.float32(INK)


# the robot


def test_pose_and_state_follow_the_conventions():
    nose_down = DrawnPose(0, 0, 0, pitch=0.1).rotation @ (1, 0, 0)
    left_up = DrawnPose(0, 0, 0, roll=0.1).rotation @ (0, 1, 0)
    left_turn = DrawnPose(0, 0, np.pi / 2).rotation @ (1, 0, 0)
    assert nose_down[2] < 0 < left_up[2]
    np.testing.assert_allclose(left_turn, (0, 1, 0), atol=1e-12)
    moved = RobotState(DrawnPose(1, 2, 0.1), velocity_xy=(0.5, -0.2), yaw_rate=0.3).pose_at(0.1)
    np.testing.assert_allclose((moved.x, moved.y, moved.yaw), (1.05, 1.98, 0.13))


def test_a_leg_is_hit_behind_its_hip_when_its_toe_points_down():
    leg = {"hip": (0.0, 0.0, 0.0), "radius": 0.035, "width": 0.02, "angle": np.pi / 2}
    behind = half_circle_hit((-1.0, 0.0, -0.035), (1.0, 0.0, 0.0), **leg)
    ahead = half_circle_hit((1.0, 0.0, -0.035), (-1.0, 0.0, 0.0), **leg)
    assert behind == pytest.approx(1 - 0.035)  # the outside of the arc
    assert ahead == pytest.approx(1 + 0.035)  # its inside, through the open half
    assert half_circle_hit((-1.0, 0.02, -0.035), (1.0, 0.0, 0.0), **leg) == np.inf
    assert half_circle_hit((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), **leg) == np.inf


def test_cover_is_the_robot_and_the_shadow_darkens_only_the_floor(background, photo):
    clean, _ = develop(background, IDEAL, rng=np.random.default_rng(0))
    changed = np.abs(photo.pixels.astype(int) - clean).sum(axis=-1) > 0
    shadow = changed & (photo.cover == 0)
    assert (photo.pixels[shadow] <= clean[shadow]).all()
    assert shadow.sum() > 0.1 * (photo.cover > 0).sum()
    v, u = np.nonzero(photo.cover > 0)
    centre = CAMERA.project(STATE.pose.position)
    np.testing.assert_allclose((u.mean(), v.mean()), centre, atol=6)


def test_motion_smears_about_the_middle_of_the_exposure(background):
    moving = replace(STATE, velocity_xy=(0.4, 0.1), yaw_rate=0.5)
    blurred = take_photo(
        SCENE, moving, conditions=replace(IDEAL, exposure_time=0.1),
        rng=np.random.default_rng(0), background=background,
    )  # fmt: skip
    still = take_photo(SCENE, STATE, rng=np.random.default_rng(0), background=background)
    assert (blurred.cover > 0).sum() > 1.1 * (still.cover > 0).sum()
    v, u = np.indices(still.cover.shape)
    for axis in (u, v):
        means = [(axis * shot.cover).sum() / shot.cover.sum() for shot in (blurred, still)]
        assert means[0] == pytest.approx(means[1], abs=0.1)


# the photograph


def test_noise_has_the_promised_spread():
    flat = np.full((200, 300, 3), 0.5, np.float32)
    kind = Conditions(exposure=1.0, read_noise_counts=2.0, shot_noise_counts=3.0, jpeg_quality=None)
    pixels, _ = develop(flat, kind, rng=np.random.default_rng(0))
    assert pixels.std() == pytest.approx(np.sqrt(4 + 9 * 0.5 + 1 / 12), rel=0.02)
    assert pixels.mean() == pytest.approx(127.5, abs=0.1)


# composites


# time stamps


@pytest.mark.parametrize("subseconds", [True, False])
def test_a_time_stamp_leaves_the_pixels_alone(photo, subseconds):
    taken = datetime(2020, 6, 1, 12, 0, 3, 987_654, tzinfo=timezone(timedelta(hours=2)))
    _, encoded = cv2.imencode(".jpg", photo.pixels)
    stamped = with_time_stamp(encoded.tobytes(), taken, subseconds=subseconds)
    picture = Image.open(io.BytesIO(stamped))
    details = picture.getexif().get_ifd(IFD.Exif)
    assert picture.getexif()[Base.Make] == "simulated"
    assert details[Base.DateTimeOriginal] == "2020:06:01 12:00:03"
    assert details.get(Base.SubsecTimeOriginal) == ("987" if subseconds else None)
    assert details[Base.OffsetTimeOriginal] == "+02:00"
    before, after = (
        cv2.imdecode(np.frombuffer(file, np.uint8), cv2.IMREAD_COLOR)
        for file in (encoded.tobytes(), stamped)
    )
    np.testing.assert_array_equal(before, after)


def imported_by(file: Path) -> set[str]:
    """List the packages that a file imports, wherever in it, but for the type of arrays."""
    nodes = list(ast.walk(ast.parse(file.read_text())))
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    names += [str(node.module) for node in nodes if isinstance(node, ast.ImportFrom)]
    return {name.partition(".")[0] for name in names if name != "model.arrays"}


@pytest.mark.parametrize(
    "file", sorted((Path(__file__).parent / "synthetic").glob("*.py")), ids=lambda file: file.name
)
def test_synthetic_photographs_share_no_code_with_the_tracker(file):
    assert not imported_by(file) & {"model", "rig", "tracking", "zebro_lab"}
