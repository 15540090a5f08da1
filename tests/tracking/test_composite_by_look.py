# SPDX-License-Identifier: MIT
"""Exposures of a robot without a marker are found by how one of them looks."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.body import Alignment, TopPlate, floor_in_view
from tracking.camera import Camera, CameraPose, project
from tracking.composite import Merged, find_exposures_like, order_exposures
from tracking.composite.body_raster import BodyRaster
from tracking.composite.candidates import headed
from tracking.composite.chain import (
    steady_chain,
    step_between,
    stepped,
    stepped_back,
    unsteadiness,
)
from tracking.composite.colours import FloorColours
from tracking.composite.known import KnownExposure
from tracking.composite.mean import Fit, MeanSearch
from tracking.composite.mean_alignment import MeanAlignment, floor_pattern
from tracking.composite.pasted_alignment import PastedReading
from tracking.composite.plane import Plane
from tracking.errors import CompositeError
from tracking.markers import square_homography
from tracking.pose import BodyPose, BodyPrior

LENS = Camera((640, 400), np.array([[760.0, 0, 320], [0, 760, 200], [0, 0, 1]]), np.zeros(5))
_TURN = np.linalg.svd([[1.0, 0, 0], [0, -0.85, -0.53], [0, 0.53, -0.85]])
VIEW = CameraPose.from_matrix(_TURN[0] @ _TURN[2], [0.0, 0.15, 1.6])
SIZE, TOP = (0.20, 0.20), 0.03  # m
PLATE = TopPlate(0.19, 0.19, TOP)
PRIOR = BodyPrior(0.06, 1e-3, 5e-3)
POSES = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-3, 3)).map(np.array)
STEPS = st.tuples(st.floats(0.05, 0.4), st.floats(-0.1, 0.1), st.floats(-0.6, 0.6)).map(np.array)


def floor(rng):
    """Draw a brown floor with a pattern in light."""
    pattern = cv2.GaussianBlur(rng.normal(0, 1, (400, 640)).astype(np.float32), (0, 0), 2)
    light = 110 + 9 * pattern / pattern.std()
    return light[..., None] * np.array([0.75, 0.95, 1.1])


def robot():
    """Draw a blue board with a red head and patches that look alike from no two sides."""
    picture = np.tile(np.array([120.0, 60, 30]), (80, 80, 1))
    picture[:10, 25:55] = (30, 30, 190)
    for row, column, colour in (
        (20, 12, (60, 140, 90)), (45, 50, (200, 190, 180)), (55, 15, (30, 30, 30)),
        (25, 45, (140, 90, 170)),
    ):  # fmt: skip
        picture[row : row + 16, column : column + 20] = colour
    return picture


def exposure(planar, rng, ground, light=1.0):
    """Photograph the board in some light; return the picture and where it shows it."""
    c, s = np.cos(planar[2]), np.sin(planar[2])
    corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * 0.5 * np.array(SIZE)
    corners = corners @ np.array([[c, s], [-s, c]]) + planar[:2]
    seen = project(LENS, VIEW, np.column_stack((corners, np.full(4, PRIOR.height + TOP))))
    own = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 80]]) / 80
    H = square_homography(seen) @ own
    drawn = cv2.warpPerspective(light * robot(), H, (640, 400), flags=cv2.INTER_AREA)
    mask = cv2.warpPerspective(np.ones((80, 80)), H, (640, 400))[..., None]
    picture = cv2.GaussianBlur(ground * (1 - mask) + drawn * mask, (0, 0), 0.6)
    return np.clip(picture + rng.normal(0, 1.2, picture.shape), 0, 255), mask[..., 0] > 0.05


def composite(walk, kind, seed=0, lights=None, around_px=0):
    """Merge exposures; pasted ones are cut out with so much floor around them."""
    rng = np.random.default_rng(seed)
    ground = floor(rng)
    lights = np.ones(len(walk)) if lights is None else lights
    pictures, masks = zip(
        *(exposure(planar, rng, ground, light) for planar, light in zip(walk, lights, strict=True)),
        strict=True,
    )
    if kind == "mean":
        return np.rint(np.mean(pictures, axis=0)).astype(np.uint8)
    if kind == "darkest":
        return np.min(pictures, axis=0).astype(np.uint8)
    whole = pictures[0].copy()
    scissors = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * around_px + 1,) * 2)
    for picture, mask in zip(pictures, masks, strict=True):
        cut = cv2.dilate(mask.astype(np.uint8), scissors) > 0
        whole[cut] = picture[cut]
    return whole.astype(np.uint8)


def known_at(planar):
    state = np.array([planar[0], planar[1], PRIOR.height, 0, 0, planar[2]])
    return BodyPose(state, np.zeros((6, 6)), np.zeros((6, 6)), 0.0, 0.0)


def found_in(picture, planar, merged, **other):
    found = find_exposures_like(
        picture, LENS, VIEW, known=known_at(planar), plate=PLATE, body_size=SIZE, prior=PRIOR,
        merged=Merged(merged), **other,
    )  # fmt: skip
    poses = np.array([each.alignment.pose.planar for each in found])
    return poses[list(order_exposures(poses))]


def likeness(picture, planar, *, reach):
    """Take a picture in which one exposure is known, to look around the middle."""
    area = floor_in_view(LENS, VIEW, PRIOR.height + TOP, (0.0, 0.0), reach)
    hidden = np.zeros(picture.shape[:2], dtype=bool)
    return KnownExposure(picture, LENS, VIEW, PRIOR, known_at(planar), PLATE, SIZE, hidden, area)


@pytest.mark.parametrize("kind", ["pasted", "mean", "darkest"])
def test_exposures_that_overlap_are_found_in_order_and_none_is_made_up(kind):
    step = np.array([0.11, 0.0, 0.12])
    walk = steady_chain(np.array([-0.22, -0.1, 0.15]), step, 0.0, 4, 0)
    poses = found_in(composite(walk, kind), walk[-1], kind, near=(0.0, 0.0), reach=0.35)
    assert len(poses) == len(walk)
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 5e-3
    assert np.degrees(np.abs(poses[:, 2] - walk[:, 2]).max()) < 2.5


@pytest.mark.parametrize(
    "how", [{"lights": np.linspace(1.5, 1.0, 5)}, {"around_px": 22}], ids=["light", "floor"]
)
def test_pasted_exposures_are_found_in_light_that_changes_and_cut_out_with_floor(how):
    step = np.array([0.15, 0.0, 0.08])
    walk = steady_chain(np.array([-0.3, -0.1, 0.1]), step, 0.0, 4, 0)
    picture = likeness(composite(walk, "pasted", **how), walk[-1], reach=0.45)
    reading = PastedReading(picture)
    found = reading.align(reading.find())
    poses = np.array([each.alignment.pose.planar for each in found])[::-1]
    assert len(poses) == len(walk)
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 3e-3


def test_exposures_beyond_reach_of_each_other_are_found_in_a_mean():
    walk = np.array([[-0.4, -0.12, 0.2], [-0.05, -0.03, 0.3], [0.3, 0.08, 0.4]])
    poses = found_in(composite(walk, "mean"), walk[1], "mean")
    assert len(poses) == 3
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 3e-3


@pytest.mark.parametrize("count", [2, 3])
def test_places_of_few_exposures_in_a_mean_do_not_depend_on_where_they_were_first_seen(count):
    walk = np.array([[-0.3, -0.1, 0.2], [0.0, 0.0, 0.3], [0.3, 0.1, 0.4]])[:count]
    picture = likeness(composite(walk, "mean"), walk[0], reach=0.45)
    started = walk + np.outer(np.arange(count) > 0, [0.004, -0.002, 0.02])
    pattern = floor_pattern(picture, picture.pixels.astype(np.float32), walk)
    flat = pattern.flat(picture.pixels.astype(np.float32))
    found = MeanAlignment(picture, [flat] * count, started, pattern).exposures()
    poses = np.array([each.alignment.pose.planar for each in found])
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 1e-3
    assert np.degrees(np.abs(poses[:, 2] - walk[:, 2]).max()) < 0.5


def test_something_that_lies_on_a_robot_does_not_draw_it_where_odd_points_are_left_out():
    planar = np.array([0.0, 0.0, 0.3])
    clean = composite(planar[None], "pasted")
    view = likeness(clean, planar, reach=0.3)
    seen = project(LENS, VIEW, np.array([[*planar[:2], PRIOR.height + TOP]]))[0].astype(int)
    covered = clean.copy()
    covered[seen[1] + 8 : seen[1] + 40, seen[0] - 60 : seen[0] + 8] = (20, 220, 220)

    def off(most_odd):
        found = view.aligned(planar, covered, view.body_template(clean), ~view.hidden,
                             least=0.0, most_odd=most_odd)  # fmt: skip
        return np.inf if found is None else np.hypot(*(found.pose.planar - planar)[:2])

    assert off(2.5) < 5e-4
    assert off(2.5) < 0.5 * off(np.inf)


def test_exposures_aligned_with_each_other_are_moved_to_where_one_is_known_to_be():
    walk = steady_chain(np.array([0.1, 0.0, 0.3]), np.array([0.2, 0.01, 0.1]), 0.0, 3, 0)
    off = np.array([0.004, -0.003, 0.02])
    picture = likeness(np.zeros((400, 640, 3), np.uint8), walk[0], reach=0.4)
    found = [Alignment(known_at(stepped(planar, off)), 0.9, 0.0) for planar in walk]
    moved = MeanAlignment(picture, [], walk).anchored([*found, None])
    assert moved[-1] is None
    planar = [each.pose.planar for each in moved[:-1]]
    np.testing.assert_allclose(planar, walk, atol=1e-9)


def test_a_floor_in_shadow_is_still_the_floor_and_the_robot_is_not():
    picture = composite(np.array([[0.0, 0.0, 0.3]]), "pasted").astype(np.float32)
    _, mask = exposure(np.array([0.0, 0.0, 0.3]), np.random.default_rng(0), picture)
    look = FloorColours.of(picture, np.ones(mask.shape, bool), width=80, noise=3.0)
    far = cv2.dilate(mask.astype(np.uint8), np.ones((9, 9))) == 0
    assert look.shows(picture)[far].mean() > 0.99
    assert look.shows(0.6 * picture)[far].mean() > 0.95
    assert look.shows(picture)[mask].mean() < 0.1


@pytest.mark.parametrize("kind", ["pasted", "mean"])
def test_one_exposure_alone_is_no_composite(kind):
    planar = np.array([0.0, 0.0, 0.3])
    with pytest.raises(CompositeError, match="but the one whose top was marked"):
        found_in(composite(planar[None], "pasted"), planar, kind, near=(0, 0), reach=0.15)


def test_a_known_exposure_cut_by_the_edge_is_refused():
    picture = composite(np.array([[0.0, 0.0, 0.3]]), "pasted")
    with pytest.raises(CompositeError, match="edge"):
        found_in(picture, np.array([0.66, 0.0, 0.0]), "pasted", near=(0.5, 0), reach=0.4)


@given(pose=POSES, step=STEPS)
def test_a_step_there_and_back_ends_where_it_began(pose, step):
    np.testing.assert_allclose(step_between(pose, stepped(pose, step)), step, atol=1e-9)
    np.testing.assert_allclose(stepped_back(stepped(pose, step), step), pose, atol=1e-9)


@given(pose=POSES, step=STEPS, more=st.floats(-0.05, 0.05))
def test_a_chain_is_the_same_from_any_of_its_exposures(pose, step, more):
    chain = steady_chain(pose, step, more, 4, 0)
    first = step_between(chain[2], chain[3])
    again = steady_chain(chain[2], first, more, 2, 2)
    np.testing.assert_allclose(again[[4, 3, 0, 1, 2]], chain, atol=1e-9)


def test_steady_steps_are_steady_and_a_slip_is_not():
    walk = steady_chain(np.zeros(3), np.array([0.1, 0.0, 0.1]), 0.0, 6, 0)
    assert unsteadiness(walk) == pytest.approx(0.0, abs=1e-12)
    walk[3, 0] += 0.02
    assert unsteadiness(walk) > 10


@given(step=STEPS, turned=st.integers(0, 3))
def test_a_square_robot_is_headed_along_the_arc_that_leads_to_it(step, turned):
    after = stepped(np.zeros(3), step * [1, 0, 1])
    seen = after + np.array([0, 0, turned * np.pi / 2])
    found = headed(seen, np.zeros((1, 3)), square=True)
    assert np.cos(found[2] - after[2]) == pytest.approx(1.0)


def level_plane():
    low, high = np.array([-0.5, -0.4]), np.array([0.5, 0.4])
    return Plane.over(LENS, VIEW, height=PRIOR.height + TOP, low=low, high=high, cell=0.006)


def test_what_is_laid_on_a_plane_is_read_again():
    body, plane = BodyRaster.over(SIZE, 0.006), level_plane()
    rng = np.random.default_rng(1)
    values = cv2.GaussianBlur(rng.normal(0, 1, (*body.x.shape, 3)).astype(np.float32), (0, 0), 3)
    pose = np.array([0.1, -0.05, 0.7])
    layer = np.zeros((*plane.seen_px.shape[:2], 3), np.float32)
    window, laid = body.laid(values, plane, pose)
    layer[window] = laid
    inner = (slice(3, -3), slice(3, -3))
    np.testing.assert_allclose(
        body.read(layer, plane, pose)[inner], values[inner], atol=0.1 * values.std()
    )


def test_a_robot_is_told_from_a_sum_of_itself():
    body, plane = BodyRaster.over(SIZE, 0.006, margin=4), level_plane()
    rng = np.random.default_rng(2)
    shape = (*plane.seen_px.shape[:2], 3)
    picture, used = rng.normal(100, 5, shape).astype(np.float32), np.ones(shape[:2], bool)
    reading = MeanSearch(plane, picture, used, body, SIZE[0], TOP)
    own = cv2.GaussianBlur(rng.normal(0, 60, (*body.x.shape, 3)).astype(np.float32), (0, 0), 2)
    poses = steady_chain(np.array([-0.25, 0.0, 0.0]), np.array([0.1, 0.0, 0.1]), 0.0, 4, 0)
    change = reading.sum_of(poses, own)
    seen = np.mean([body.read(change, plane, pose) for pose in poses], axis=0)
    solved = reading.robot_at(poses, change)
    assert np.corrcoef(solved.ravel(), own.ravel())[0, 1] > 0.97
    assert np.corrcoef(seen.ravel(), own.ravel())[0, 1] < 0.9  # what many others would take


def test_of_a_mean_what_is_weaker_or_less_like_the_robot_than_is_usual_is_dropped():
    body, plane = BodyRaster.over(SIZE, 0.006, margin=4), level_plane()
    picture = np.zeros((*plane.seen_px.shape[:2], 3), np.float32)
    reading = MeanSearch(plane, picture, np.ones(picture.shape[:2], bool), body, SIZE[0], TOP)
    poses = steady_chain(np.array([-0.4, 0.0, 0.0]), np.array([0.1, 0.0, 0.0]), 0.0, 6, 0)
    scores = np.array([0.1, 0.9, 0.9, 0.65, 0.9, 0.9, 0.7])
    strengths = np.array([0.1, 1.0, 1.0, 1.0, 0.4, 1.0, 1.0])
    held = reading.held(Fit(poses, picture, scores, strengths, 0.0, 0.0))
    np.testing.assert_array_equal(held, poses[[0, 1, 2, 5, 6]])
    faint = np.full(len(poses), 0.55)
    assert len(reading.held(Fit(poses, picture, faint, np.ones(len(poses)), 0.0, 0.0))) == 7
    assert len(reading.held(Fit(poses, picture, 0.9 * faint, strengths, 0.0, 0.0))) == 1


@given(count=st.integers(2, 20), own=st.floats(0.01, 0.2), grown=st.floats(0.6, 1.6))
def test_one_exposure_more_must_explain_its_cost_whatever_else_it_changes(count, own, grown):
    fewer = explaining(0.5, count, own)
    cost = 0.5 * (own + grown * own)
    more = explaining(0.5 + 1.01 * cost, count + 1, grown * own)
    assert more.gain(fewer) > 0
    assert fewer.gain(more) == pytest.approx(-more.gain(fewer))
    assert explaining(0.5 + 0.99 * cost, count + 1, grown * own).gain(fewer) < 0
    assert explaining(0.6, count, grown * own).gain(fewer) == pytest.approx(0.1)


def explaining(share, count, cost):
    """Return a set of exposures that explains a share of a picture."""
    return Fit(
        np.zeros((count, 3)), np.zeros((1, 1, 3)), np.ones(count), np.ones(count), share, cost
    )


def test_a_robot_on_the_floor_does_not_change_how_the_floor_looks():
    rng = np.random.default_rng(3)
    picture = (floor(rng) + rng.normal(0, 1, (400, 640, 3))).astype(np.float32)
    used = np.ones(picture.shape[:2], bool)
    bare = FloorColours.of(picture, used, width=60, noise=0.5)
    picture[100:220, 100:220] = (120, 60, 30)
    with_robot = FloorColours.of(picture, used, width=60, noise=0.5)
    white = bare.whitening.T @ with_robot.covariance @ bare.whitening
    np.testing.assert_allclose(white, np.eye(3), atol=0.2)
    far = with_robot.oddness(picture)
    assert far[130:190, 130:190].min() > 30
    assert np.median(far[300:]) == pytest.approx(np.median(bare.oddness(picture)[300:]), rel=0.1)
