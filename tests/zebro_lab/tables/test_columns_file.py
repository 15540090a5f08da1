# SPDX-License-Identifier: MIT
"""`columns.toml`, parsed once into frozen values: its sections, and what nobody has checked."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip.definition import SlipDefinition
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.tables.columns import MappedColumn
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import RigColumns, RigErrorsStated, RunRule
from zebro_lab.tables.row_conditions import RowCondition

WHOLE = """
source = "sim:sweep"
[columns.t]
name = "ET"
unit = "ms"
[columns.normal_force]
name = "FZ"
unit = "kN"
sign = -1
[columns.slip_ratio]
name = "SL"
definition = "travel"
[columns.run]
name = "trial"
[constants]
radius_leg = "35 mm"
radius_ground = 0.12
[runs]
gap = "500 ms"
[rows]
keep = ["beta == 0", "`slip ratio` > 0.05"]
[load_cell]
zero_stability = "150 mN"
gain_sd = "0.5 %"
[rig_errors]
radius = "0.2 mm"
rolling_resistance = "1 %"
"""


def read(tmp_path: Path, text: str) -> RigColumns:
    file = tmp_path / "columns.toml"
    file.write_text(text, encoding="utf-8")
    return read_columns(file)


def test_every_key_is_read_in_si(tmp_path):
    assert read(tmp_path, WHOLE) == RigColumns(
        file=tmp_path / "columns.toml",
        source="sim:sweep",
        columns={
            "t": MappedColumn("ET", "ms", 1e-3, unit_stated=True),
            "normal_force": MappedColumn("FZ", "kN", -1e3, unit_stated=True),
            "slip_ratio": MappedColumn("SL", "dimensionless", 1.0, SlipDefinition.TRAVEL),
            "run": MappedColumn("trial"),
        },
        constants={"radius_leg": 0.035, "radius_ground": 0.12},
        runs=RunRule(gap=0.5),
        keep=(RowCondition("beta", "==", 0), RowCondition("slip ratio", ">", 0.05)),
        load_cell={"zero_stability": 0.15, "gain_sd": 0.005},
        rig_errors=RigErrorsStated(radius=2e-4, rolling_resistance=0.01),
    )


def test_empty_file_changes_nothing(tmp_path):
    assert read(tmp_path, "") == RigColumns(file=tmp_path / "columns.toml")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('sorce = "real"', "sorce: unknown key; did you mean 'source'"),
        ('source = "simulated"', "found 'simulated'; expected real, sim:WHAT"),
        ("[columns.t]\nunits = 's'", "columns.t.units: unknown key; did you mean 'unit'"),
        ("[columns.t]\nunit = 'frobs'", "columns.t.unit: unknown unit 'frobs'"),
        ("[columns.normal_force]\nunit = 'V'", 'or scale = NUMBER, unit = "N" if 1 in the file'),
        ("[columns.t]\nscale = 0.1", "columns.t.scale: stands beside no unit; expected one"),
        ("[columns.t]\nsign = 2", "columns.t.sign: found 2; expected 1 or -1"),
        ("[constants]\nradius_leg = '35 N'", "constants.radius_leg: unit 'N' cannot"),
        ("[runs]\nby = ['a']\ngap = 1", "runs: found by and gap; keep only one"),
        ("[rows]\nkeep = ['slip']", "rows.keep: 'slip' is not a condition"),
        ("[load_cell]\ngain_sd = 1", r"gain_sd: is 1, which is improbable; .* such as \"1 %\" "),
        (
            "[rig_errors]\nradius = 0.1",
            r"radius: is 0.1 m, which is improbable; .* such as \"0.1 mm\" ",
        ),
    ],
)
def test_fault_is_one_line_that_names_file_and_key(tmp_path, text, message):
    with pytest.raises(SettingsError, match=message) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(str(tmp_path / "columns.toml"))
    assert "\n" not in str(caught.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(NotFound, match=r"absent\.toml: no such file"):
        read_columns(tmp_path / "absent.toml")


def table(units: dict[str, str], **columns) -> RawTable:
    return RawTable(Path("a.csv"), {n: pd.Series(c) for n, c in columns.items()}, units=units)


def test_a_scale_converts_numbers_to_the_unit_that_is_stated(tmp_path):
    text = '[columns.t]\nunit = "ms"\nscale = 0.1\n[columns.normal_force]\nname = "C"\n'
    columns = read(tmp_path, text + 'unit = "N"\nscale = 40\nsign = -1\noffset = "1 N"\n').columns
    raw = table({"C": "V"}, t=[0, 10], C=[-0.125, -0.25])
    np.testing.assert_allclose(columns["t"].in_unit_of(raw, "s").in_si(raw), [0, 1e-3])
    force = columns["normal_force"].in_unit_of(raw, "N")
    np.testing.assert_allclose(force.in_si(raw), [6.0, 11.0])
    assert force.said == "'C' in 40 N times -40"


def test_offset_and_nanoseconds_are_added_in_si(tmp_path):
    columns = read(
        tmp_path,
        '[columns.t]\nname = "s"\nnanoseconds = "ns"\n'
        '[columns.normal_force]\nname = "F"\nunit = "kN"\nsign = "-1"\noffset = "5 N"\n',
    ).columns
    raw = table({}, s=[10, 11], ns=[500_000_000, 0], F=[1.0, 2.0])
    np.testing.assert_array_equal(columns["t"].in_si(raw), [10.5, 11])
    np.testing.assert_array_equal(columns["normal_force"].in_si(raw), [-995, -1995])


def test_priors_are_texts_of_the_parameter_and_what_is_known(tmp_path):
    text = '[priors]\nfriction = "0.4 ± 0.05"\nshape = "uniform(1.4, 1.7)"\nmu = "~ normal(1, 2)"\n'
    assert read(tmp_path, text).priors == (
        "friction = 0.4 ± 0.05", "shape ~ uniform(1.4, 1.7)", "mu ~ normal(1, 2)"
    )  # fmt: skip
    with pytest.raises(SettingsError, match=r"priors\.friction"):
        read(tmp_path, "[priors]\nfriction = 0.4\n")
