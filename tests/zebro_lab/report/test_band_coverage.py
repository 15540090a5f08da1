# SPDX-License-Identifier: MIT
"""A share inside a band is out of range where few independent walks would have it."""

import pytest

from zebro_lab.report.band_coverage import out_of_range

WITHIN = {"poses": 14.0, "coverage50_x": 0.5, "coverage90_x": 1.0, "coverage95_yaw": 13 / 14}


def test_shares_that_chance_explains_are_within_their_range():
    assert list(out_of_range(WITHIN)) == []


@pytest.mark.parametrize(
    ("key", "share"),
    [("coverage90_x", 9 / 14), ("coverage50_y", 1.0), ("coverage50_yaw", 0.0)],
)
def test_bands_too_narrow_and_too_wide_are_out_of_range(key, share):
    (found,) = out_of_range({**WITHIN, key: share})
    assert found.key == key
    assert not found.low <= 100 * share <= found.high


def test_the_range_narrows_with_the_number_of_poses():
    assert list(out_of_range({"poses": 10, "coverage90_x": 0.8})) == []
    (found,) = out_of_range({"poses": 1000, "coverage90_x": 0.8})
    assert (round(found.low), round(found.high)) == (88, 92)


@pytest.mark.parametrize(
    "row",
    [
        {}, {"poses": 0, "coverage90_x": 0.0}, {"poses": 14, "coverage90_x": None},
        {"poses": "14", "coverage90_x": 0.0}, {"poses": 14, "coverage90_x": "0"},
        {"poses": 14, "coverage90_x": True}, {"poses": 14, "coverage90_x": float("nan")},
    ],
)  # fmt: skip
def test_what_is_unknown_is_not_judged(row):
    assert list(out_of_range(row)) == []
