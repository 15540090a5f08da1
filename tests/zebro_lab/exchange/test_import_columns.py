# SPDX-License-Identifier: MIT
"""Every imported file has its section of columns.toml, or all of a file without sections."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.exchange.import_columns import ForeignColumns, foreign_columns
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable

SECTIONS = """
source = "sim:x"
[legs]
topic = "/joints"
columns.theta1 = {name = "fl", unit = "deg"}
[imu.columns]
roll = "R"
[rig.columns]
t = "time"
"""


@pytest.fixture
def find(tmp_path):
    """Return what finds the columns of a kind of file beside a columns.toml of this text."""

    def finder(what: str, text: str | None, named: Path | None = None) -> ForeignColumns:
        if text is not None:
            (tmp_path / "columns.toml").write_text(text)
        return foreign_columns(what, tmp_path / "table.csv", named)

    return finder


def test_each_file_has_its_section_and_the_common_source(find, tmp_path):
    legs, imu = find("legs", SECTIONS), find("imu", SECTIONS)
    assert (legs.topic, imu.topic) == ("/joints", None)
    mapped, rig = legs.series("legs"), find("rig", SECTIONS).rig()
    raw = RawTable(Path("a.csv"), {"fl": pd.Series([180.0])})
    found = mapped.numbers(raw, "theta1", what="", advice="")
    np.testing.assert_allclose(found, [np.pi])
    assert imu.series("imu").mapped["roll"].name == "R"
    assert rig.columns["t"].name == "time"
    track = find("track", SECTIONS).series("track")
    assert track.mapped["x_m"].name == "x_m"
    assert {mapped.source, track.source, rig.source} == {"sim:x"}
    assert mapped.file == tmp_path / "columns.toml"


def test_a_file_without_sections_is_of_legs_and_rigs_alone(find):
    text = 'source = "real"\n[columns]\nt = "time"\n'
    assert find("legs", text).series("legs").mapped["t"].name == "time"
    assert find("rig", text).rig().columns["t"].name == "time"
    imu = find("imu", text).series("imu")
    assert (imu.mapped["t"].name, imu.source) == ("t", "real")


def test_without_a_file_names_are_canonical(find):
    found = find("imu", None)
    assert found == ForeignColumns()
    assert found.series("imu").mapped["roll"].unit == "rad"
    assert found.series("imu").where == "imu."
    assert found.rig() == Columns()


def test_a_named_file_counts_in_place_of_that_beside_the_table(find, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text('[imu.columns]\nroll = "theirs"')
    assert find("imu", SECTIONS, other).series("imu").mapped["roll"].name == "theirs"
    with pytest.raises(NotFound, match=r"expected a columns\.toml"):
        find("imu", SECTIONS, tmp_path / "absent.toml")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[legs]\n[leg.columns]", "leg: unknown key; did you mean 'legs'"),
        ("legs = 3", "legs: found 3; expected a section"),
        ("[legs]\n[columns]\nt = 'time'", "columns: unknown key"),
    ],
)
def test_a_fault_names_file_and_key(find, tmp_path, text, message):
    with pytest.raises(SettingsError, match=message) as raised:
        find("legs", text)
    assert raised.value.file == tmp_path / "columns.toml"
