# SPDX-License-Identifier: MIT
"""Columns of a rig table in SI: radii, conditions on rows, signs of the load."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from support.rig_tables import columns, given_slip, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError
from zebro_lab.tables.columns import MappedColumn
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import RigColumns
from zebro_lab.tables.rig_table import RigTable, normal_force
from zebro_lab.tables.row_conditions import kept_rows, parse_row_condition


def table_of(columns: dict[str, MappedColumn], constants: dict[str, float], **values) -> RigTable:
    """Return a rig table of two rows, of which the second is kept."""
    series = {name: pd.Series(each) for name, each in values.items()}
    settings = RigColumns(file=Path("columns.toml"), columns=columns, constants=constants)
    return RigTable(RawTable(Path("rig.csv"), series), settings, np.array([1]))


def test_columns_are_in_si_with_the_canonical_sign_of_the_kept_rows():
    mapped = {"normal_force": MappedColumn("FZ", "kN", -1e3)}
    table = table_of(mapped, {}, FZ=[-1.0, -2.0], t=[0.0, 0.1], run=["a", "b"])
    np.testing.assert_array_equal(table.si("normal_force"), [2000.0])
    np.testing.assert_array_equal(table.si("t"), [0.1])
    assert table.texts("run").tolist() == ["b"]
    assert table.source_of("traction_force") is None


def test_unused_columns_are_numbers_that_neither_the_map_nor_the_runs_need():
    mapped = {"normal_force": MappedColumn("FZ", "kN", -1e3)}
    table = table_of(
        mapped, {}, FZ=[-1.0, -2.0], t=[0.0, 0.1], run=["a", "b"], room=[19.0, 21.0],
        operator=["x", "y"], gap=[1.0, np.nan],
    )  # fmt: skip
    assert {name: values.tolist() for name, values in table.unused().items()} == {"room": [21.0]}


def test_a_cell_is_named_as_the_file_has_it():
    table = table_of({"normal_force": MappedColumn("FZ", "kN", -1e3)}, {}, FZ=[-1.0, 2.0])
    with pytest.raises(
        DataError, match="column 'FZ', row 2: the normal force is 2 kN; expected more"
    ):
        normal_force(table)
    with pytest.raises(DataError, match=r"leg disc is missing; .*columns.omega_leg"):
        table.si("omega_leg")


@pytest.mark.parametrize(("factor", "cell"), [(1.0, 9.9e37), (-1.0, 9.9e37), (1.0, -9.9e37)])
def test_an_overload_is_skipped_by_the_conditions_that_are_proposed(factor, cell):
    mapped = {"traction_force": MappedColumn("Fx", "N", factor)}
    table = table_of(mapped, {}, Fx=[1.0, cell])
    conditions = ["`Fx` > -1e+30", "`Fx` < 1e+30"]
    with pytest.raises(DataError, match="which instruments write at an overload") as raised:
        table.si("traction_force")
    assert f"keep = {json.dumps(conditions)}" in str(raised.value)
    settings = RigColumns(columns=mapped, keep=tuple(map(parse_row_condition, conditions)))
    assert kept_rows(table.raw, settings.keep).tolist() == [0]


def test_a_load_that_is_negative_nearly_everywhere_is_given_its_sign():
    with pytest.raises(DataError, match="sign = -1"):
        normal_force(table_of({}, {}, normal_force=[-5.0, -5.0]))


def test_a_radius_is_a_constant_or_a_column_and_positive():
    assert table_of({}, {"radius_leg": 0.035}).constant_or_column("radius_leg") == 0.035
    by_row = table_of({}, {}, radius_leg=[0.1, 0.2]).constant_or_column("radius_leg")
    np.testing.assert_array_equal(by_row, [0.2])
    with pytest.raises(
        DataError, match=r"columns\.toml, column 'radius_leg': radius_leg in \[constants\] is 0 m"
    ):
        table_of({}, {"radius_leg": 0.0}).constant_or_column("radius_leg")
    with pytest.raises(DataError, match=r"column 'radius_leg', row 2: is -1 m; expected"):
        table_of({}, {}, radius_leg=[0.1, -1.0]).constant_or_column("radius_leg")
    with pytest.raises(DataError, match="missing, but needed with the speeds of the discs"):
        table_of({}, {}).constant_or_column("radius_leg")
    with pytest.raises(DataError, match="given twice"):
        table_of({}, {"radius_leg": 0.1}, radius_leg=[0.1, 0.1]).constant_or_column("radius_leg")


def test_a_load_that_is_stated_once_is_that_of_every_row(tmp_path):
    path = write(tmp_path, given_slip().drop(columns="normal_force"))
    columns(tmp_path, "constants.normal_force = '6600 mN'")
    np.testing.assert_allclose(read_rig_data([path]).samples.normal_force, np.full(40, 6.6))
    write(tmp_path, given_slip())
    with pytest.raises(DataError, match=r"given twice, .* \[constants\] normal_force = 6.6 N"):
        read_rig_data([path])


def test_a_coefficient_times_the_load_is_the_traction(tmp_path):
    table = given_slip()
    mu = 100 * table["traction_force"] / table["normal_force"]
    path = write(tmp_path, table.drop(columns="traction_force").assign(mu=mu, sd=1.0))
    mapped = "[columns]\ntraction_coefficient = { name = 'mu', unit = '%' }\n"
    columns(tmp_path, mapped + "traction_coefficient_sd = { name = 'sd', unit = '%' }\n")
    samples = read_rig_data([path]).samples
    np.testing.assert_allclose(samples.traction_force, table["traction_force"])
    np.testing.assert_allclose(samples.force_sd, 0.01 * table["normal_force"])


def test_standard_deviations_follow_their_rows_and_are_above_zero(tmp_path):
    table = given_slip().assign(sd=np.arange(1.0, 41.0), run=np.repeat([1, 2], 20))
    columns(tmp_path, "columns.traction_force_sd = { name = 'sd', unit = 'mN' }\n"
            "rows.keep = ['sd > 3']\nruns.leave_out = [1]")  # fmt: skip
    path = write(tmp_path, table)
    data = read_rig_data([path])
    np.testing.assert_allclose(data.samples.force_sd, 1e-3 * np.arange(21, 41))
    other = write(tmp_path / "other", given_slip().assign(traction_force=1.0))
    columns(other.parent, "")
    both = read_rig_data([path, other])
    assert both.samples.force_sd is None
    assert "1 of 2 files have no traction_force_sd, so none is used" in both.notes
    write(tmp_path, table.assign(sd=0.0))
    columns(tmp_path, "columns.traction_force_sd = 'sd'")
    with pytest.raises(DataError, match=r"row 1 .*the standard deviation is 0 N; expected more"):
        read_rig_data([path])


def test_table_without_any_condition_met_is_an_error(tmp_path):
    columns(tmp_path, "rows.keep = ['t > 100']")
    with pytest.raises(DataError, match=r"none of the 40 rows meets \[rows\] keep: t > 100"):
        read_rig_data([write(tmp_path, given_slip())])
