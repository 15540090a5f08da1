# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from support.curve_tables import thesis_table, written_curve
from support.rig_tables import speeds, write
from zebro_lab.calibration.curve_table import is_curve_table, read_curve_table
from zebro_lab.files.errors import DataError


def test_forces_at_loads_are_read_with_their_definition(tmp_path):
    table = thesis_table()
    found = read_curve_table(written_curve(tmp_path / "curve.csv", table))
    np.testing.assert_allclose(found.slip, table["slip_ratio"])
    np.testing.assert_allclose(found.load, table["normal_force"])
    np.testing.assert_allclose(found.traction, table["traction_force"])
    assert (str(found.definition), found.source) == ("material", "unknown")
    assert found.files == (tmp_path / "curve.csv",)


def test_headers_units_and_definition_may_be_stated_in_columns_toml(tmp_path):
    table = thesis_table((6.63,)).drop(columns="slip_definition")
    table = table.assign(slip_ratio=100 * table["slip_ratio"]).rename(columns={"slip_ratio": "sx"})
    path = written_curve(tmp_path / "curve.csv", table)
    path.with_name("columns.toml").write_text(
        'source = "real"\n'
        '[columns]\nslip_ratio = {name = "sx", unit = "%", definition = "travel"}\n'
    )
    found = read_curve_table(path)
    assert (found.slip.max(), str(found.definition), found.source) == (1.0, "travel", "real")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.drop(columns="slip_definition"), "definition of the slip ratio is not known"),
        (lambda t: t.drop(columns="traction_force"), "a table of a curve has slip_ratio"),
        (lambda t: t.drop(columns="normal_force"), "normal_force.*is missing"),
        (lambda t: t.head(2), "has 2 points"),
    ],
)
def test_what_a_table_lacks_or_has_twice_is_named(tmp_path, change, message):
    path = written_curve(tmp_path / "curve.csv", change(thesis_table((6.63,))))
    with pytest.raises(DataError, match=message):
        read_curve_table(path)


def test_a_table_of_samples_is_no_table_of_a_curve(tmp_path):
    assert is_curve_table(written_curve(tmp_path / "curve" / "curve.csv", thesis_table()))
    assert not is_curve_table(write(tmp_path / "rig", speeds()))
    assert not is_curve_table(tmp_path)
