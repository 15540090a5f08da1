# SPDX-License-Identifier: MIT
"""Validation of a walk, used as a notebook would."""

from pathlib import Path

import pytest

import zebro_lab as zl

pytestmark = pytest.mark.usefixtures("blank_pictures")

WALK = Path(__file__).parents[3] / "datasets" / "walk-sim"


def test_a_prediction_is_validated_against_a_track(tmp_path):
    zl.walk_gait("tripod", slip="coulomb:0.38", duration=4.0, steering=1.2, out=tmp_path / "walk")
    done = zl.validate_walks((tmp_path / "walk", WALK / "truth.csv"))
    rows = {row.name: row.errors.ate for row in done.runs[0].rows}
    assert rows["prediction"] < rows["stand still"]
