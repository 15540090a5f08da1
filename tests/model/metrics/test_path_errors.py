# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.metrics.alignment import align
from model.metrics.path_errors import path_errors, pose_errors, relative_error
from model.poses import Poses

angles = st.floats(-3.0, 3.0)
shifts = st.tuples(st.floats(-5, 5), st.floats(-5, 5))


def circle(*, radius=1.7, rate=0.05, duration=30.0, n=31, crab=0.0, speed=1.0) -> Poses:
    """Poses on a circle to the left at uneven times."""
    rng = np.random.default_rng(3)
    t = np.sort(np.concatenate([[0.0, duration], rng.uniform(0, duration, n - 2)]))
    turned = rate * speed * t
    xy = radius * np.column_stack([np.sin(turned), 1 - np.cos(turned)])
    return Poses(t, xy, turned + crab)


@given(rotation=angles, shift=shifts)
def test_errors_along_and_across_do_not_depend_on_the_floor_frame(rotation, shift):
    track, predicted = circle(), circle(radius=1.8)
    here = path_errors(predicted, track)
    there = path_errors(
        predicted.moved(rotation=rotation, translation=shift),
        track.moved(rotation=rotation, translation=shift),
    )
    for name in ("ate", "along", "cross", "yaw", "ate_aligned", "final_distance"):
        assert getattr(there, name) == pytest.approx(getattr(here, name), abs=1e-9)


def test_a_path_has_no_error_against_itself():
    errors = path_errors(circle(), circle())
    assert errors.ate == errors.yaw == errors.final_distance == 0
    assert errors.length_ratio == 1
    assert all(each.position < 1e-12 for each in errors.relative)


def test_along_and_across_make_up_the_distance():
    errors = pose_errors(circle(radius=1.9, speed=1.05), circle())
    np.testing.assert_allclose(np.hypot(errors.along, errors.cross), errors.distance)


def test_a_path_that_is_ahead_errs_along_only():
    t = np.linspace(0, 10, 11)
    track = Poses(t, np.column_stack([0.1 * t, 0 * t]), 0 * t)
    ahead = Poses(t, np.column_stack([0.105 * t, 0 * t]), 0 * t)
    errors = path_errors(ahead, track)
    assert errors.cross == pytest.approx(0, abs=1e-12)
    assert errors.length_ratio == pytest.approx(1.05)
    assert pose_errors(ahead, track).along[-1] == pytest.approx(0.05)


def test_alignment_hides_a_wrong_start_heading_that_the_unaligned_error_shows():
    track = circle()
    wrong = track.moved(rotation=np.radians(11), translation=(0, 0))
    errors = path_errors(wrong, track)
    assert errors.ate_aligned < 1e-9
    assert errors.ate > 0.1
    assert np.degrees(errors.yaw) == pytest.approx(11)
    assert np.degrees(errors.alignment_yaw) == pytest.approx(-11)


def test_a_motion_over_a_distance_forgets_the_wrong_start():
    track = circle()
    wrong = track.moved(rotation=0.5, translation=(1, 2))
    found = relative_error(wrong, track, distance=0.5)
    assert found.pairs > 5
    assert found.position < 1e-12


def test_tracked_poses_outside_the_prediction_are_left_out():
    track = circle()
    errors = path_errors(track.part(track.t <= 20), track)
    assert errors.poses == int((track.t <= track.t[track.t <= 20][-1]).sum())


def test_a_track_without_headings_has_errors_of_position_only():
    track = circle()
    blind = Poses(track.t, track.position, np.full(len(track), np.nan))
    errors = path_errors(circle(radius=1.8), blind)
    assert np.isfinite([errors.ate, errors.along, errors.cross, errors.ate_aligned]).all()
    assert np.isnan([errors.yaw, errors.yaw_rate[1], errors.radius[1]]).all()


def test_alignment_has_no_better_neighbour():
    track, predicted = circle(), circle(radius=2.0)
    best = align(predicted, track)

    def ate(rotation, translation):
        moved = predicted.moved(rotation=rotation, translation=translation)
        return np.mean(pose_errors(moved, track).distance ** 2)

    here = ate(*best)
    for turn, dx, dy in ((1e-3, 0, 0), (-1e-3, 0, 0), (0, 1e-3, 0), (0, 0, -1e-3)):
        assert ate(best.rotation + turn, best.translation + np.array([dx, dy])) > here
