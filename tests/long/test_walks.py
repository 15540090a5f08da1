# SPDX-License-Identifier: MIT
"""What walks must do for a prediction, on walks of an independent engine; tables are printed."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.accuracy import predicted_walks
from benchmarks.accuracy.lab_walks import Bench

COLUMNS = """
source = "sim:virtual-world"
columns.normal_force = "Fn"
columns.traction_force = "Ft"
columns.omega_leg = "omega_l"
columns.omega_ground = "omega_g"
constants = { radius_leg = "35 mm", radius_ground = "120 mm" }
runs.by = ["Fn_set", "kappa_set"]
"""
RADIUS, YAW_RATE, OF_PATH = 0.02, 0.1, 0.02  # of radius, deg/s, rms of path
COVERED = (0.80, 0.97)

pytestmark = [pytest.mark.long, pytest.mark.reference, pytest.mark.timeout(5400)]


@pytest.fixture(scope="module")
def bench(shared, tmp_path_factory):
    place = tmp_path_factory.mktemp("walks")
    (place / "columns.toml").write_text(COLUMNS)
    command = Path(sys.executable).with_name("calibrate-slip")
    subprocess.run(
        [command, shared / "virtual-world" / "rig", "--columns", place / "columns.toml",
         "--curvature", "constant", "--out", place / "calibration"],
        check=True, capture_output=True,
    )  # fmt: skip
    return Bench(place / "calibration", place / "walks")


@pytest.fixture(scope="module")
def half_circles(bench):
    scored = list(predicted_walks.half_circles(bench))
    predicted_walks.print_rows(scored)
    return scored


def within(each):
    error, unit = each.turn_error
    return abs(error) < (RADIUS if unit == "of radius" else YAW_RATE)


def test_turns_are_predicted_within_two_percent(half_circles):
    for each in half_circles:
        assert within(each), each.walk.name


def test_positions_are_predicted_within_two_percent_of_the_path(half_circles):
    for each in half_circles:
        assert each.judged.rows[0].errors.ate_of_length < OF_PATH, each.walk.name


def test_bands_hold_what_they_say(half_circles):
    held = np.concatenate([predicted_walks.cover(each) for each in half_circles])
    assert COVERED[0] <= held.mean() <= COVERED[1]


def test_scores_beat_those_of_every_baseline(half_circles):
    for each in half_circles:
        prediction, *others = each.judged.rows
        assert prediction.scores.energy < min(other.scores.energy for other in others)
