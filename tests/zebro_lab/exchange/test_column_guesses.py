# SPDX-License-Identifier: MIT
"""Columns are recognised by their headers, set-points by how seldom they change."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.exchange.column_guesses import guess_columns, guess_set_points, numbers_or_none
from zebro_lab.tables.raw_table import RawTable


def test_canonical_header_is_recognised_whole():
    names = ["t", "omega_leg", "omega_ground", "radius_leg", "radius_ground", "normal_force",
             "traction_force", "run"]  # fmt: skip
    table = RawTable(Path("a.csv"), {name: pd.Series([1.0, 2.0]) for name in names})
    assert {canonical: guess.name for canonical, guess in guess_columns(table).items()} == {
        name: name for name in names
    }


def test_set_point_is_what_changes_seldom():
    steps, slope = np.repeat([1.0, 2.0, 3.0], 50), np.arange(150.0)
    table = RawTable(
        Path("a.csv"),
        {"set": pd.Series(steps), "slope": pd.Series(slope), "one": pd.Series(np.ones(150))},
    )
    assert guess_set_points(table) == ["set"]


@pytest.mark.parametrize(
    ("header", "canonical", "unit"),
    [
        ("FZ [N]", "normal_force", "N"), ("Fn (kN)", "normal_force", "kN"),
        ("t_ms", "t", "ms"), ("Time", "t", None), ("omega_l_rpm", "omega_leg", "rpm"),
        ("Slip Ratio", "slip_ratio", None), ("FX [mm]", "traction_force", None),
    ],
)  # fmt: skip
def test_a_header_gives_name_and_unit(header, canonical, unit):
    table = RawTable(Path("a.csv"), {header: pd.Series([1.0, 2.0])})
    (found,) = guess_columns(table).items()
    assert (found[0], found[1].name, found[1].unit) == (canonical, header, unit)


def test_the_canonical_name_wins_and_other_matches_and_signs_are_kept():
    columns = {
        "FZ": pd.Series([5.0]),
        "normal_force": pd.Series([-5.0]),
        "colour": pd.Series(["r"]),
    }
    (guess,) = guess_columns(RawTable(Path("a.csv"), columns)).values()
    assert (guess.name, guess.others, guess.negative) == ("normal_force", ("FZ",), True)


def test_numbers_are_none_for_texts_and_empty_columns():
    table = RawTable(Path("a.csv"), {"a": pd.Series(["x"]), "b": pd.Series([np.nan]),
                                     "c": pd.Series([np.nan, 1.0])})  # fmt: skip
    assert numbers_or_none(table, "a") is None
    assert numbers_or_none(table, "b") is None
    np.testing.assert_array_equal(numbers_or_none(table, "c"), [np.nan, 1.0])
