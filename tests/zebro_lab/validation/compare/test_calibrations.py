# SPDX-License-Identifier: MIT
"""Calibrations are compared at loads that both were tested at."""

import pytest

from support.compared_folders import calibration, compared
from zebro_lab.files.errors import DataError
from zebro_lab.validation.compare.request import CompareRequest
from zebro_lab.validation.compare.stage import compare

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_more_friction_is_more_traction_and_the_same_slope(tmp_path):
    one = calibration(tmp_path / "one")
    other = calibration(tmp_path / "other", friction=0.44)
    _, by_name = compared(one, other, tmp_path / "out")
    traction = by_name["largest traction over load at 7.5 N"]
    assert traction.median == pytest.approx(0.04, abs=0.005)
    # 0.04 apart, each with a standard deviation of 0.01.
    assert traction.probability == pytest.approx(0.9977, abs=0.004)
    assert traction.clear
    slope = by_name["initial slope over load at 7.5 N"]
    assert not slope.clear
    assert slope.probability == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize(
    ("options", "problem"),
    [({"definition": "travel"}, "no axis"), ({"loads": (20.0, 30.0)}, "no load is common")],
)
def test_calibrations_without_anything_in_common_are_refused(tmp_path, options, problem):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", **options)
    with pytest.raises(DataError, match=problem):
        compare(CompareRequest(one, other, tmp_path / "out"))
    assert not (tmp_path / "out").exists()
