# SPDX-License-Identifier: MIT
"""`columns.toml`, parsed once into frozen values: its sections, and what nobody has checked."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip.definition import SlipDefinition
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.tables.columns import Columns, MappedColumn, RigErrorsStated, RunRule
from zebro_lab.tables.columns_file import (
    columns_above,
    nearest_columns,
    read_columns,
    read_nearest,
    read_section,
)
from zebro_lab.tables.raw_table import RawTable
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


def read(tmp_path: Path, text: str) -> Columns:
    file = tmp_path / "columns.toml"
    file.write_text(text, encoding="utf-8")
    return read_columns(file)


def test_every_key_is_read_in_si(tmp_path):
    assert read(tmp_path, WHOLE) == Columns(
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
    assert read(tmp_path, "") == Columns(file=tmp_path / "columns.toml")


@pytest.mark.parametrize("source", ["import:legs.csv", "mixed:real,sim:imu"])
def test_the_source_of_an_exported_run_is_accepted(tmp_path, source):
    assert read(tmp_path, f'source = "{source}"').source == source


def test_byte_order_mark_is_accepted(tmp_path):
    assert read(tmp_path, '\ufeffsource = "real"').source == "real"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('sorce = "real"', "sorce: unknown key; did you mean 'source'"),
        ('source = "simulated"', "found 'simulated'; expected real, sim:WHAT"),
        ("source = 3", "source: found 3; expected a text"),
        ("columns = 3", "columns: found 3; expected a table"),
        ("[columns.normal_froce]", "did you mean 'normal_force'"),
        ("[columns.t]\nunits = 's'", "columns.t.units: unknown key; did you mean 'unit'"),
        ("[columns.t]\nunit = 'frobs'", "columns.t.unit: unknown unit 'frobs'"),
        ("[columns.normal_force]\nunit = 'mm'", "unit 'mm' cannot be converted to N"),
        ("[columns.normal_force]\nunit = 'V'", 'or scale = NUMBER, unit = "N" if 1 in the file'),
        ("[columns.t]\nscale = 0.1", "columns.t.scale: stands beside no unit; expected one"),
        ("[columns.t]\nscale = 0.1\nunit = 'date'", "stands beside the unit 'date'; expected one"),
        ("[columns.t]\nscale = -1\nunit = 's'", "columns.t.scale: is -1; expected more than 0"),
        ("[columns.t]\nsign = 2", "columns.t.sign: found 2; expected 1 or -1"),
        ("[columns.t]\nsign = true", "columns.t.sign: found True; expected 1 or -1"),
        ("[columns.t]\nname = 3", "columns.t.name: found 3; expected a text"),
        ("[columns.t]\ndefinition = 'travel'", "columns.t.definition: unknown key"),
        ("[columns.slip_ratio]\ndefinition = 'travels'", "did you mean 'travel'"),
        ("[constants]\nradius = 0.1", "constants.radius: unknown key; did you mean 'radius_leg'"),
        ("[constants]\nradius_leg = '35 N'", "constants.radius_leg: unit 'N' cannot"),
        ("[constants]\nradius_leg = true", "expected a number in m"),
        ("[runs]\nby = ['a']\ngap = 1", "runs: found by and gap; keep only one"),
        ("[runs]\nby = [1]", r"runs.by: found \[1\]; expected a text or a list"),
        ("[runs]\ngap = 0", "runs.gap: is 0 s; expected more than 0"),
        ("[runs]\neach_row = 1", "runs.each_row: found 1; expected true or false"),
        ("[rows]\nkeep = ['slip']", "rows.keep: 'slip' is not a condition"),
        ("[load_cell]\ngain = 0.1", "load_cell.gain: unknown key; did you mean 'gain_sd'"),
        ("[load_cell]\ngain_sd = 1", r"gain_sd: is 1, which is improbable; .* such as \"1 %\" "),
        ("[load_cell]\ngain_sd = -0.1", "load_cell.gain_sd: is -0.1; expected 0 or more"),
        (
            "[rig_errors]\nradius = 0.1",
            r"radius: is 0.1 m, which is improbable; .* such as \"0.1 mm\" ",
        ),
        ("[rig_errors]\nradius = 0", "rig_errors.radius: is 0 m; expected more than 0"),
        ("[columns", "cannot be read as TOML"),
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


def test_dates_of_a_time_become_unix_time(tmp_path):
    columns = read(tmp_path, '[columns]\nt = {name = "when", unit = "date"}\n').columns
    raw = table({}, when=["1970-01-01T00:00:01.5Z", "1970-01-01T01:00:02+01:00"])
    np.testing.assert_array_equal(columns["t"].in_si(raw), [1.5, 2])
    with pytest.raises(SettingsError, match="unknown unit 'date'"):
        read(tmp_path, '[columns]\nnormal_force = {name = "when", unit = "date"}\n')


def section(folder, text, kind="rig"):
    (folder / "columns.toml").write_text(text)
    return read_section(kind, folder / "columns.toml")


def test_entries_without_sections_are_for_rig_and_legs(tmp_path):
    text = 'source = "real"\n[columns]\nt = "ET"\n'
    for kind in ("rig", "legs"):
        assert section(tmp_path, text, kind).left == ("source", "columns")
    for kind in ("imu", "track"):
        assert section(tmp_path, text, kind).left == ("source",)


def test_each_kind_has_a_section_and_all_share_the_source(tmp_path):
    text = 'source = "real"\n[legs.columns]\nt = "ET"\n[track]\nsheet = "A"\n'
    assert section(tmp_path, text, "legs").left == ("source", "columns")
    assert section(tmp_path, text, "track").text("sheet") == "A"
    assert section(tmp_path, text, "rig").left == ("source",)


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ('[columns.t]\nunit = "ms?"', 'columns.t.unit = "ms?"'),
        ('[columns.t]\nsign = "-1?"', 'columns.t.sign = "-1?"'),
        ('[columns]\nt = "ET?"', 'columns.t = "ET?"'),
        ('[constants]\nradius_leg = "35 mm?"', 'constants.radius_leg = "35 mm?"'),
        ('[runs]\nby = ["a", "b?"]', 'runs.by = "b?"'),
        ('[rig.columns.t]\nname = "ET?"\nunit = "?"', 'name = "ET?", rig.columns.t.unit = "?"'),
    ],
)
def test_a_guess_that_nobody_checked_is_refused(tmp_path, text, keys):
    with pytest.raises(SettingsError, match="nobody has checked") as raised:
        section(tmp_path, text)
    assert keys in str(raised.value)


def test_guesses_of_another_kind_of_table_do_not_matter(tmp_path):
    text = '[legs.columns.t]\nunit = "ms?"\n[rig.columns]\nt = "ET"\n[rig.rows]\nkeep = ["a? > 1"]'
    assert "columns" in section(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "problem"), [("[legs]\n[leg]\n", "leg: unknown key"), ("legs = 1", "a section")]
)
def test_what_is_no_section_is_refused(tmp_path, text, problem):
    with pytest.raises(SettingsError, match=problem):
        section(tmp_path, text, "legs")


def test_the_nearest_columns_with_something_for_the_kind_are_taken(tmp_path, monkeypatch):
    deep = tmp_path / "a" / "b"
    deep.mkdir(parents=True)
    assert nearest_columns("track", deep) is None
    (tmp_path / "columns.toml").write_text("[track.columns.y_m]\nsign = -1\n")
    (tmp_path / "a" / "columns.toml").write_text('source = "real"\n')
    assert nearest_columns("track", deep) == tmp_path / "columns.toml"
    assert nearest_columns("imu", deep) == tmp_path / "a" / "columns.toml"  # for its source
    assert nearest_columns("rig", deep) == tmp_path / "a" / "columns.toml"
    (deep / "columns.toml").write_text("[track]\n")
    assert nearest_columns("track", deep) == deep / "columns.toml"
    monkeypatch.chdir(tmp_path)
    assert nearest_columns("rig", Path("a/b")) == Path("a/columns.toml")


def test_a_map_of_a_rig_above_is_none_of_legs_and_the_other_way_round(tmp_path):
    below = tmp_path / "walks"
    below.mkdir()
    (tmp_path / "columns.toml").write_text('[columns]\nnormal_force = "FZ"\n')
    assert nearest_columns("legs", below) is None
    assert nearest_columns("rig", below) == tmp_path / "columns.toml"
    (tmp_path / "columns.toml").write_text('[columns]\ntheta1 = "fl"\n')
    assert nearest_columns("rig", below) is None
    assert nearest_columns("legs", below) == tmp_path / "columns.toml"
    assert nearest_columns("rig", tmp_path) == tmp_path / "columns.toml"


@pytest.mark.parametrize(
    ("above", "beside", "source"),
    [
        ("[track]\n", 'source = "sim:robot"\n[legs]\n', "sim:robot"),
        ('source = "real"\n[track]\n', 'source = "sim:robot"\n[legs]\n', "sim:robot"),
        ("[track]\n", 'source = "sim:robot"\n[columns]\nt = "ET"\n', "sim:robot"),
        ('source = "sim:robot"\n[legs]\n', "[track]\n", "sim:robot"),
        ('source = "real"\n[track]\n', '[track]\nsource = "sim:robot"\n', "sim:robot"),
    ],
)
def test_the_source_is_the_nearest_whichever_file_maps_the_columns(tmp_path, above, beside, source):
    below = tmp_path / "run"
    below.mkdir()
    (tmp_path / "columns.toml").write_text(above)
    (below / "columns.toml").write_text(beside)
    found = read_nearest("track", below)
    assert found is not None
    assert found.text("source") == source


def test_a_nearer_source_that_is_none_names_its_own_file(tmp_path):
    below = tmp_path / "run"
    below.mkdir()
    (tmp_path / "columns.toml").write_text("[rig]\n")
    (below / "columns.toml").write_text('source = "simulated"\n[legs]\n')
    with pytest.raises(SettingsError, match="found 'simulated'; expected real") as raised:
        read_nearest("rig", below)
    assert raised.value.file == below / "columns.toml"


def test_what_is_stated_above_the_named_folder_is_noted(tmp_path):
    below = tmp_path / "run"
    below.mkdir()
    table, file = below / "a.csv", tmp_path / "columns.toml"
    assert columns_above("track", table, None) == ()
    file.write_text('source = "real"\n[track.columns.y_m]\nsign = -1\n')
    mapped, source = columns_above("track", table, None)
    assert mapped == f"a.csv: columns are those of {file}, the nearest for track above it"
    assert source == f"a.csv: its source, real, is stated in {file}, above it"
    assert columns_above("legs", table, None) == (source,)
    assert columns_above("track", table, file) == ()
    assert columns_above("track", table, None, root=tmp_path) == ()
    (below / "columns.toml").write_text("[track]\n")
    assert columns_above("track", table, None) == (source,)


def test_a_result_of_a_command_takes_no_columns_from_above(tmp_path):
    result = tmp_path / "walk"
    result.mkdir()
    (tmp_path / "columns.toml").write_text('[legs.columns]\ntheta1 = "fl"\n')
    assert nearest_columns("legs", result) == tmp_path / "columns.toml"
    (result / "manifest.json").write_text('{"kind": "walk", "schema": 1, "outputs": {}}')
    assert nearest_columns("legs", result) is None


def test_priors_are_texts_of_the_parameter_and_what_is_known(tmp_path):
    text = '[priors]\nfriction = "0.4 ± 0.05"\nshape = "uniform(1.4, 1.7)"\nmu = "~ normal(1, 2)"\n'
    assert read(tmp_path, text).priors == (
        "friction = 0.4 ± 0.05", "shape ~ uniform(1.4, 1.7)", "mu ~ normal(1, 2)"
    )  # fmt: skip
    with pytest.raises(SettingsError, match=r"priors\.friction"):
        read(tmp_path, "[priors]\nfriction = 0.4\n")
