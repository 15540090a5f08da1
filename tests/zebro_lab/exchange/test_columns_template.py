# SPDX-License-Identifier: MIT
"""Guesses are written with a question mark and the reason beside it."""

import tomllib
from pathlib import Path

import pandas as pd
import pytest

from zebro_lab.exchange.column_guesses import guess_columns
from zebro_lab.exchange.columns_template import render_columns
from zebro_lab.tables.raw_table import RawTable


def rendered(kind, columns, **how) -> str:
    table = RawTable(Path("a.csv"), {name: pd.Series(cells) for name, cells in columns.items()})
    return render_columns(table, kind, guess_columns(table, kind), **how)


def test_a_section_holds_all_entries_of_its_kind():
    columns = {"t": [0.0, 1.0], "FZ": [-5.0, -6.0], "set": [1.0, 1.0]}
    text = rendered("rig", columns, sectioned=True, appended=True, sheet="A")
    read = tomllib.loads(text)
    assert set(read) == {"rig"}
    tables = {"columns", "constants", "runs", "rows", "load_cell", "rig_errors"}
    assert set(read["rig"]) == {"sheet", *tables}
    assert read["rig"]["columns"]["normal_force"]["sign"] == "-1?"
    assert '#   "set": first 1, from 1 to 1' in text


def test_zero_and_order_of_leg_angles_are_to_check():
    columns = {"t": [0.0, 1.0], **{f"leg{i}": [0.0, 1.0] for i in range(1, 7)}}
    read = tomllib.loads(rendered("legs", columns, sectioned=True))["legs"]["columns"]
    assert read["t"] == {"name": "t", "unit": "s?"}
    assert read["theta6"] == {
        "name": "leg6?", "unit": "rad?", "sign": "1?", "offset": "0 deg?",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("header", "definition"),
    [("SRR (%)", "mean?"), ("Slide-to-roll ratio [-]", "mean?"), ("creepage", "mean?"),
     ("slide/roll ratio", "mean?"), ("slip [%]", "?"), ("SR", "?")],
)  # fmt: skip
def test_slip_over_the_mean_speed_is_proposed_where_its_name_says_so(header, definition):
    read = tomllib.loads(rendered("rig", {"t": [0.0, 1.0], header: [0.1, 0.2], "FX": [1.0, 2.0]}))
    assert read["columns"]["slip_ratio"]["definition"] == definition


def test_what_a_table_of_means_lacks_is_asked_for():
    read = tomllib.loads(rendered("rig", {"slip [%]": [0.1, 35.0], "friction force [N]": [0.3, 2]}))
    assert read["constants"] == {"normal_force": "?"}
    assert read["runs"] == {"each_row": "?"}
    whole = {"t": [0.0, 1.0], "slip [%]": [0.1, 35.0], "FX": [0.3, 2.0], "FZ": [6.0, 6.0]}
    assert tomllib.loads(rendered("rig", whole))["constants"] == {}
    assert tomllib.loads(rendered("rig", whole))["runs"] == {}
