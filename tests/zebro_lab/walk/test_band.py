# SPDX-License-Identifier: MIT
"""Draws of a path start where asked, are the same by seed, and come back from their file."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from model.gait import tripod_angles, tripod_reference
from model.gait.inexact_log import InexactLog
from model.leg_state import ANISOTROPY
from model.path_draws import bent, length_and_turn, states_at
from model.poses import Poses
from support.validated_walks import predicted, write_walk_data
from support.watchers import Nobody
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.band import (
    ASSUMED_OFFSET_DEG,
    band_settings,
    in_the_middle,
    offset_sd_deg,
    predict_band,
)
from zebro_lab.walk.folder import DRAWS, read_draws
from zebro_lab.walk.request import BandRequest
from zebro_lab.walk.walking import Walked


def test_draws_come_back_and_stale_ones_go(tmp_path):
    legs, _ = write_walk_data(tmp_path)
    folder = predicted(tmp_path, legs, draws=4)
    draws = read_draws(folder)
    assert draws.position.shape == (4, len(draws.t), 2)
    band = pd.read_csv(folder / "band.csv")
    assert (band["x_q050"] <= band["x_q950"]).all()
    predicted(tmp_path, legs, draws=0)
    with pytest.raises(NotFound, match="--draws"):
        read_draws(folder)


GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)


@pytest.fixture(scope="module")
def band(walked) -> Callable[..., Poses]:
    """Return what draws a band of three paths of that gait."""
    slip = parse_slip("coulomb:0.4")
    single = Walked(walked, GAIT, RobotFile(), slip, "dynamics", 0.001, "a walk", ())

    def draw(*, seed: int = 1, model: str = "dynamics", **options) -> Poses:
        request = BandRequest(3, seed, offset_sd_deg=1.0, **options)
        return predict_band(request, replace(single, model=model), GAIT, duration=0.5,
                            watcher=Nobody())  # fmt: skip

    return draw


@pytest.fixture(scope="module")
def three(band) -> Poses:
    return band()


def test_draws_start_at_the_origin_and_are_the_same_by_seed(three, band):
    np.testing.assert_allclose(three.t, np.linspace(0.0, 0.5, 6))
    np.testing.assert_allclose(three.states[:, 0], 0.0, atol=1e-12)
    assert len({path.tobytes() for path in three.position}) == 3
    np.testing.assert_array_equal(band().states, three.states)
    assert not np.array_equal(band(seed=2).states, three.states)


def test_the_manifest_says_what_the_band_takes_of_lateral_traction():
    assert band_settings(BandRequest(2), None)["anisotropy"] == ANISOTROPY


def test_a_model_that_does_not_slip_has_no_band(band):
    with pytest.raises(SettingsError, match="by the model 'dynamics' only, not by 'thesis'"):
        band(model="thesis")


def test_offsets_spread_as_asked_by_the_count_or_as_assumed():
    request = BandRequest(2)
    t = np.linspace(0.0, 1.0, 11)
    counted = InexactLog(t, np.zeros((11, 6)), np.radians(3.6))
    assert offset_sd_deg(BandRequest(2, offset_sd_deg=0.7), counted) == 0.7
    assert offset_sd_deg(request, counted) == pytest.approx(3.6 / np.sqrt(12))
    fine = InexactLog(t, np.zeros((11, 6)), np.radians(0.1))
    assert offset_sd_deg(request, fine) == ASSUMED_OFFSET_DEG
    assert offset_sd_deg(request, GAIT) == ASSUMED_OFFSET_DEG


@pytest.mark.parametrize(
    ("t", "poses", "message"),
    [
        ([[0.0, 1.0]], np.zeros((2, 2, 3)), r"at times of shape \(1, 2\); delete"),
        ([0.0, 1.0], np.zeros((2, 3, 3)), r"holds poses of shape \(2, 3, 3\)"),
        ([], np.zeros((2, 0, 3)), r"holds poses of shape \(2, 0, 3\)"),
        ([1.0, 1.0], np.zeros((2, 2, 3)), "holds times that do not increase; delete draws"),
        (["a", "b"], np.zeros((2, 2, 3)), "cannot be read as poses"),
    ],
)
def test_draws_of_another_shape_are_refused(tmp_path, t, poses, message):
    np.savez(tmp_path / DRAWS, t=np.array(t), poses=poses)
    with pytest.raises(DataError, match=message):
        read_draws(tmp_path)


def test_a_single_path_is_moved_to_the_middle_of_its_band(walked, three):
    single = Walked(walked, GAIT, RobotFile(), None, "dynamics", 0.001, "a walk", ())
    bend = {"distance": np.array([0.1, 0.12, 0.2]), "curvature": np.array([0.5, 0.6, -1.0])}
    band = bent(three, **bend)
    path = in_the_middle(single, band).path
    middle = Poses.of_states(band.t, states_at(path.poses.draws(), band.t))
    for found, draws in zip(length_and_turn(middle), length_and_turn(band), strict=True):
        assert found[0] == pytest.approx(np.median(draws), abs=1e-3)
    assert path.position.shape == walked.position.shape
