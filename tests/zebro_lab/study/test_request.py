# SPDX-License-Identifier: MIT
"""Options of studies that contradict each other are wrong usage."""

from pathlib import Path

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.study.request import CoverageRequest, LayoutRequest, SbcRequest

CALIBRATION = LayoutRequest(calibration=Path("c"))


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: LayoutRequest(plan=Path("p"), calibration=Path("c")), "--plan"),
        (lambda: SbcRequest(CALIBRATION, law="brush"), "--law"),
        (lambda: CoverageRequest(CALIBRATION, truth=Path("t")), "--truth"),
        (lambda: LayoutRequest(prior=("friction",)), "--prior"),
    ],
)
def test_contradictions_name_the_option(make, key):
    with pytest.raises(SettingsError, match=f"^{key}: "):
        make()


def test_what_is_read_is_listed():
    assert CALIBRATION.inputs == (Path("c"),)
    assert LayoutRequest().inputs == ()
    SbcRequest(LayoutRequest(), law="brush")
