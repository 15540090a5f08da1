# SPDX-License-Identifier: MIT
"""Every fault of the input is one line that names the place and what to try."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError, ZebroLabError

N = 30


def good() -> pd.DataFrame:
    """A table without fault."""
    return pd.DataFrame({
        "t": np.arange(N) * 0.01,
        "slip_ratio": np.linspace(0, 0.3, N),
        "normal_force": np.full(N, 5.0),
        "traction_force": np.linspace(0, 2, N),
        "slip_definition": "material",
    })  # fmt: skip


def with_speeds() -> pd.DataFrame:
    return good().drop(columns=["slip_ratio", "slip_definition"]).assign(
        omega_leg=12.0, omega_ground=np.linspace(3, 2, N), radius_leg=0.035, radius_ground=0.12
    )  # fmt: skip


def put(column: str, row: int, value: object) -> pd.DataFrame:
    """Put a value into a data row, counted from 1."""
    table = good().astype(object)
    table.loc[row - 1, column] = value
    return table


CSV_FAULTS: dict[str, tuple[pd.DataFrame, str]] = {
    "missing column": (
        good().rename(columns={"normal_force": "Normal Force"}),
        "column 'normal_force': the column of the normal force is missing; did you mean 'Normal",
    ),
    "missing slip": (
        good().drop(columns=["slip_ratio", "slip_definition"]),
        "slip ratio with its definition, or of omega_leg and omega_ground with the radii, is",
    ),
    "one speed": (
        with_speeds().drop(columns="omega_ground"),
        "column 'omega_ground': the column of the angular speed of the ground disc is missing",
    ),
    "nan": (
        put("traction_force", 7, None),
        "column 'traction_force', row 7 (line 8): is empty; expected finite numbers",
    ),
    "infinite": (put("normal_force", 3, "-inf"), '[rows] keep = ["`normal_force` > -1e+30", "'),
    "nan in time": (put("t", 4, None), "column 't', row 4 (line 5)"),
    "text": (
        put("normal_force", 5, "n/m"),
        "column 'normal_force', row 5 (line 6): 'n/m' is not a number; correct or delete",
    ),
    "row of units": (
        put("normal_force", 1, "[N]"),
        "row 1 (line 2): '[N]' is not a number; if the row holds units",
    ),
    "negative load": (
        put("normal_force", 12, -0.3),
        "column 'normal_force', row 12 (line 13): the normal force is -0.3 N; expected more than 0",
    ),
    "zero load": (put("normal_force", 12, 0), "normal force is 0 N"),
    "wrong sign": (good().assign(normal_force=-5.0), "sign = -1"),
    "constant slip": (good().assign(slip_ratio=0.1), "slip ratio is 0.1 in all 30 rows"),
    "constant slip seen by noisy sensors": (
        pd.DataFrame(
            {
                "t": np.arange(2000) * 0.01,
                "slip_ratio": np.random.default_rng(6).normal(0.1, 0.006, 2000),
                "normal_force": 5.0,
                "traction_force": 1.0,
                "slip_definition": "material",
            }
        ),
        "within its sensors' noise",
    ),
    "two definitions in a file": (
        put("slip_definition", 9, "travel"),
        "column 'slip_definition', row 9 (line 10): the file holds two slip definitions",
    ),
    "unknown definition": (
        good().assign(slip_definition="materiel"),
        "unknown slip definition 'materiel'; did you mean 'material'",
    ),
    "no definition": (
        good().drop(columns="slip_definition"),
        "column 'slip_ratio': the definition of the slip ratio is not known",
    ),
    "slip in percent": (
        good().assign(slip_ratio=np.linspace(0, 30, N)),
        "row 3 (line 4): the slip ratio is 2.06897, impossible for the definition 'material'",
    ),
    "time backwards": (
        put("t", 6, 0.0),
        "time goes back to 0 s; sort the rows by time, or if a new run",
    ),
    "zero radius": (
        with_speeds().assign(radius_leg=0.0),
        "column 'radius_leg', row 1 (line 2): is 0 m; expected more than 0",
    ),
    "no radius": (
        with_speeds().drop(columns="radius_ground"),
        "column 'radius_ground': the radius is missing, but needed with the speeds of the discs",
    ),
    "standing disc": (
        with_speeds().assign(omega_leg=0.0),
        "column 'omega_leg', row 1 (line 2): the leg disc stands still (0 rad/s)",
    ),
    "few samples": (good().head(3), "3 samples in all, expected at least 20"),
    "header only": (good().head(0), "has a header but no rows"),
}


def message_of(path: Path, **options) -> str:
    """Read, expect an error, and return its one line."""
    with pytest.raises(ZebroLabError) as caught:
        read_rig_data([path], **options)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("fault", CSV_FAULTS)
def test_fault_in_a_table_is_named(tmp_path, fault):
    table, expected = CSV_FAULTS[fault]
    path = tmp_path / "rig.csv"
    table.to_csv(path, index=False)
    message = message_of(path)
    assert expected in message
    assert message.startswith(str(path))


def test_error_carries_its_values(tmp_path):
    put("normal_force", 12, -0.3).to_csv(tmp_path / "rig.csv", index=False)
    with pytest.raises(DataError) as caught:
        read_rig_data([tmp_path])
    error = caught.value
    assert (error.file, error.column, error.row) == (tmp_path / "rig.csv", "normal_force", 12)
    assert (error.line, error.value, error.unit) == (13, -0.3, "N")


COLUMN_FAULTS = {
    "unknown unit": ("[columns.normal_force]\nunit = 'Newtom'", "unknown unit 'Newtom'"),
    "wrong dimension": (
        "[columns.normal_force]\nunit = 'mm'",
        "columns.normal_force.unit: unit 'mm' cannot be converted to N",
    ),
    "mapped column missing": (
        "[columns.normal_force]\nname = 'FZ'",
        "column 'FZ': is missing; known: 't', 'slip_ratio'",
    ),
    "zero constant radius": (
        "[constants]\nradius_leg = 0\nradius_ground = 0.12",
        "column 'radius_leg': radius_leg in [constants] is 0 m; expected more than 0 m",
    ),
    "rule column missing": ("runs.by = ['set']", "column 'set': is missing"),
    "condition column missing": ("rows.keep = ['beta == 0']", "column 'beta': is missing"),
}


@pytest.mark.parametrize("fault", COLUMN_FAULTS)
def test_fault_in_the_column_map_is_named(tmp_path, fault):
    text, expected = COLUMN_FAULTS[fault]
    (tmp_path / "columns.toml").write_text(text)
    table = with_speeds().drop(columns=["radius_leg", "radius_ground"])
    (table if "radius" in fault else good()).to_csv(tmp_path / "rig.csv", index=False)
    assert expected in message_of(tmp_path)


def test_two_definitions_in_two_files_are_refused(tmp_path):
    good().to_csv(tmp_path / "a.csv", index=False)
    good().assign(slip_definition="travel").to_csv(tmp_path / "b.csv", index=False)
    message = message_of(tmp_path)
    assert message.startswith(str(tmp_path / "b.csv"))
    assert f"slip is 'travel' here and 'material' in {tmp_path / 'a.csv'}" in message
    other = good().assign(slip_definition="travel").eval("normal_force = 1.01 * normal_force")
    other.to_csv(tmp_path / "b.csv", index=False)
    assert len(read_rig_data([tmp_path], slip_definition="travel").samples) == 2 * N


def test_empty_folder_and_wrong_paths_are_named(tmp_path):
    assert f"{tmp_path}: holds no data; expected files ending in .csv" in message_of(tmp_path)
    assert "absent: no such file or folder" in message_of(tmp_path / "absent")
    (tmp_path / "rig.docx").write_bytes(b"PK")
    assert "is not a table file; expected a name ending in" in message_of(tmp_path / "rig.docx")
    (tmp_path / "slip.toml").write_text("")
    assert "is the result of a calibration" in message_of(tmp_path)
    with pytest.raises(ZebroLabError, match="no data given"):
        read_rig_data([])
