# SPDX-License-Identifier: MIT
"""Tables of every accepted form become the same samples."""

import gzip
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip import convert_slip
from support.table_runs import slip_rig_run
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.mcap.slip_rig_log import SlipRigTable

RADII = '[constants]\nradius_leg = "35 mm"\nradius_ground = 0.12\n'
N = 40


def speeds(n: int = N) -> pd.DataFrame:
    """A rig table in canonical columns."""
    slip = np.linspace(0.0, 0.5, n)
    omega_leg = np.full(n, 12.0)
    return pd.DataFrame({
        "t": np.arange(n) * 0.004,
        "omega_leg": omega_leg,
        "omega_ground": (1 - slip) * omega_leg * 0.035 / 0.12,
        "normal_force": 6.63 + 0.1 * np.sin(np.arange(n)),
        "traction_force": 2.5 * np.tanh(10 * slip),
    })  # fmt: skip


def louder(table: pd.DataFrame, factor: float = 1.01) -> pd.DataFrame:
    """Another recording: the same forces twice would count once."""
    return table.assign(traction_force=factor * table["traction_force"])


def given_slip(definition: str = "travel") -> pd.DataFrame:
    """The same with the slip ratio given."""
    table = speeds()
    slip = convert_slip(np.linspace(0.0, 0.5, N), "material", definition)
    return table.drop(columns=["omega_leg", "omega_ground"]).assign(
        slip_ratio=slip, slip_definition=definition
    )


def write(folder: Path, table: pd.DataFrame, name: str = "rig.csv", **how) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    table.to_csv(folder / name, index=False, **how)
    return folder / name


def columns(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "columns.toml").write_text(text)
    return folder / "columns.toml"


def assert_same(found: RigData, expected: RigData) -> None:
    for name in ("slip", "normal_force", "traction_force", "time"):
        np.testing.assert_allclose(
            getattr(found.samples, name), getattr(expected.samples, name), rtol=0, atol=1e-12
        )


@pytest.fixture
def plain(tmp_path: Path) -> RigData:
    """The table as plain canonical CSV."""
    columns(tmp_path / "plain", RADII)
    return read_rig_data([write(tmp_path / "plain", speeds())])


def test_slip_from_disc_speeds_is_material(plain):
    assert plain.samples.definition == "material"
    np.testing.assert_allclose(plain.samples.slip, np.linspace(0.0, 0.5, N), atol=1e-12)
    assert plain.samples.run_names == ("rig",)
    assert plain.notes[0] == "slip from the disc speeds and radii, material"
    assert plain.source == "unknown"


@pytest.mark.parametrize("form", ["csv.gz", "parquet", "bom", "semicolon", "decimal comma", "tab"])
def test_every_form_of_file_reads_the_same(tmp_path, plain, form):
    folder = tmp_path / "other"
    columns(folder, RADII)
    if form == "csv.gz":
        write(folder, speeds(), "rig.csv.gz")
    elif form == "parquet":
        speeds().to_parquet(folder / "rig.parquet")
    elif form == "bom":
        write(folder, speeds(), encoding="utf-8-sig")
    elif form == "semicolon":
        write(folder, speeds(), sep=";")
    elif form == "decimal comma":
        write(folder, speeds(), sep=";", decimal=",")
    else:
        write(folder, speeds(), sep="\t")
    assert_same(read_rig_data([folder]), plain)


def test_foreign_separator_is_noted(tmp_path):
    columns(tmp_path, RADII)
    data = read_rig_data([write(tmp_path, speeds(), sep=";")])
    assert "rig.csv: read as separated by semicolons" in data.notes


def test_foreign_names_units_and_signs_are_converted(tmp_path, plain):
    table = speeds()
    foreign = pd.DataFrame({
        "Zeit [ms]": table.t * 1e3,
        "n1": table.omega_leg * 60 / (2 * np.pi),
        "n2": table.omega_ground * 60 / (2 * np.pi),
        "FZ": -table.normal_force / 1e3,
        "FX": table.traction_force,
    })  # fmt: skip
    columns(
        tmp_path,
        """
        source = "real"
        columns.t = { name = "Zeit [ms]", unit = "ms" }
        columns.omega_leg = { name = "n1", unit = "rpm" }
        columns.omega_ground = { name = "n2", unit = "rpm" }
        columns.normal_force = { name = "FZ", unit = "kN", sign = -1 }
        columns.traction_force = "FX"
        """
        + RADII,
    )
    data = read_rig_data([write(tmp_path, foreign)])
    assert_same(data, plain)
    assert data.source == "real"
    assert "normal_force: 'FZ' in kN times -1000" in data.notes


def test_radii_may_be_columns(tmp_path, plain):
    path = write(tmp_path, speeds().assign(radius_leg=0.035, radius_ground=0.12))
    assert_same(read_rig_data([path]), plain)


def test_run_folder_reads_as_its_table(tmp_path, plain):
    table = SlipRigTable(*speeds().to_numpy().T)
    folder = slip_rig_run(
        tmp_path / "DATA", table, label="rig", material="steel", operator="a", source="sim:test",
        start=datetime(2026, 1, 2, tzinfo=UTC), radius_leg=0.035, radius_ground=0.12,
    )  # fmt: skip
    for path in (folder, folder.parent, folder / "run.json"):
        data = read_rig_data([path])
        assert_same(data, plain)
        assert data.source == "sim:test"
        assert data.samples.run_names == (folder.name,)
        assert data.files == (folder / "run.json", folder / "log.mcap")


def test_row_conditions_and_load_cell_apply_to_run_folders(tmp_path):
    table = SlipRigTable(*speeds().to_numpy().T)
    folder = slip_rig_run(
        tmp_path / "DATA", table, label="rig", material="steel", operator="a", source="sim:test",
        start=datetime(2026, 1, 2, tzinfo=UTC), radius_leg=0.035, radius_ground=0.12,
    )  # fmt: skip
    columns(folder.parent, "rows.keep = ['t >= 0.04']\nload_cell.gain_sd = 0.01")
    data = read_rig_data([folder.parent])
    assert len(data.samples) == N - 10
    assert data.load_cell == {"gain_sd": 0.01}


def test_given_slip_keeps_its_definition(tmp_path):
    data = read_rig_data([write(tmp_path, given_slip("travel"))])
    assert data.samples.definition == "travel"
    assert data.notes[0] == "slip as given in 'slip_ratio', travel"


@pytest.mark.parametrize("definition", ["material", "travel", "larger"])
def test_asked_definition_is_reached_from_speeds_and_from_given_slip(tmp_path, plain, definition):
    for number, table in enumerate((speeds(), given_slip("travel"), given_slip("larger"))):
        folder = tmp_path / str(number)
        columns(folder, RADII)
        data = read_rig_data([write(folder, table)], slip_definition=definition)
        assert data.samples.definition == definition
        expected = convert_slip(plain.samples.slip, "material", definition)
        np.testing.assert_allclose(data.samples.slip, expected, atol=1e-12)


def test_slip_given_without_definition_yields_to_speeds(tmp_path):
    columns(tmp_path, RADII)
    data = read_rig_data([write(tmp_path, speeds().assign(slip_ratio=0.9))])
    assert data.samples.slip.max() == pytest.approx(0.5)
    assert "'slip_ratio' has no stated definition and was not used" in data.notes[0]


def test_slip_mapped_with_definition_wins_over_speeds(tmp_path):
    columns(tmp_path, "columns.slip_ratio = { name = 'SL', definition = 'travel' }\n" + RADII)
    table = speeds().assign(SL=np.linspace(0, 0.1, N))
    data = read_rig_data([write(tmp_path, table)])
    assert data.samples.slip.max() == pytest.approx(0.1)
    assert "speeds are there too and were not used" in data.notes[0]


def test_measured_slip_may_pass_its_limit_by_noise(tmp_path):
    table = given_slip("material").assign(slip_ratio=np.linspace(0, 1.02, N))
    assert read_rig_data([write(tmp_path, table)]).samples.slip.max() == pytest.approx(1.02)


def test_each_file_is_a_run_by_default(tmp_path):
    columns(tmp_path, RADII)
    write(tmp_path / "b", speeds())
    write(tmp_path / "a", louder(speeds()))
    data = read_rig_data([tmp_path])
    assert data.samples.n_runs == 2
    assert data.samples.run_names == (str(Path("a", "rig")), str(Path("b", "rig")))
    assert "2 runs, one a file" in data.notes


def test_run_column_and_by_separate_the_same_runs(tmp_path):
    by_column = write(tmp_path / "1", given_slip().assign(run=np.repeat([3, 1, 3, 2], N // 4)))
    by_rule = write(tmp_path / "2", given_slip().assign(set=np.repeat([3, 1, 3, 2], N // 4)))
    columns(by_rule.parent, "runs.by = 'set'")
    first, second = read_rig_data([by_column]).samples, read_rig_data([by_rule]).samples
    np.testing.assert_array_equal(first.run, second.run)
    assert first.run_names == ("rig run=3", "rig run=1", "rig run=3 (2)", "rig run=2")
    assert second.run_names[0] == "rig set=3"


def test_pause_separates_runs_and_left_out_rows_do_not(tmp_path):
    table = given_slip()
    table.loc[20:, "t"] += 2.0
    table["warm"] = 1
    table.loc[5:10, "warm"] = 0
    columns(tmp_path, "runs.gap = '0.01 s'\nrows.keep = ['warm == 1']")
    data = read_rig_data([write(tmp_path, table)])
    assert data.samples.run_names == ("rig run 1", "rig run 2")
    assert data.samples.run.tolist() == [0] * 14 + [1] * 20
    assert "6 of 40 rows left out; kept where warm == 1" in data.notes


def test_each_row_is_a_trial_without_time(tmp_path):
    columns(tmp_path, "runs.each_row = true")
    data = read_rig_data([write(tmp_path, given_slip().head(12))])
    assert data.samples.n_runs == len(data.samples) == 12
    assert data.samples.time is None


def test_conditions_drop_rows_that_are_no_numbers(tmp_path):
    table = given_slip()
    table.loc[3, "normal_force"] = np.nan
    columns(tmp_path, "rows.keep = ['normal_force < 1e9']")
    assert len(read_rig_data([write(tmp_path, table)]).samples) == N - 1


def test_nearest_columns_file_wins_and_an_explicit_one_over_all(tmp_path):
    columns(tmp_path, "source = 'real'")
    path = write(tmp_path / "below" / "deep", given_slip())
    assert read_rig_data([tmp_path]).source == "real"
    assert read_rig_data([path]).source == "unknown"  # the folder above was not named
    columns(tmp_path / "below", "source = 'sim:a'")
    assert read_rig_data([tmp_path]).source == "sim:a"
    elsewhere = columns(tmp_path / "elsewhere", "source = 'sim:b'")
    data = read_rig_data([path], columns=elsewhere)
    assert data.source == "sim:b"
    assert data.files == (path, elsewhere)


def test_source_in_parquet_is_kept_and_mixing_is_visible(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    arrow = pa.Table.from_pandas(given_slip()).replace_schema_metadata({"source": "sim:disc"})
    pq.write_table(arrow, tmp_path / "a.parquet")
    assert read_rig_data([tmp_path]).source == "sim:disc"
    write(tmp_path, louder(given_slip()), "b.csv")
    assert read_rig_data([tmp_path]).source == "mixed:sim:disc,unknown"


def test_hidden_files_and_calibration_outputs_are_passed_over(tmp_path):
    path = write(tmp_path, given_slip())
    write(tmp_path / ".cache", given_slip())
    write(tmp_path / "calibration", pd.DataFrame({"parameter": ["mu"]}), "summary.csv")
    (tmp_path / "calibration" / "slip.toml").write_text("")
    assert read_rig_data([tmp_path]).files == (path,)


def test_what_is_named_twice_counts_once(tmp_path):
    path = write(tmp_path, given_slip())
    assert len(read_rig_data([path, tmp_path, path]).samples) == N


def test_load_cells_of_several_files_must_agree(tmp_path):
    for name, value in (("a", 0.1), ("b", 0.2)):
        write(tmp_path / name, louder(given_slip(), 1 + value))
        columns(tmp_path / name, f"load_cell.zero_stability = {value}")
    assert read_rig_data([tmp_path / "a"]).load_cell == {"zero_stability": 0.1}
    with pytest.raises(SettingsError, match=r"b/columns\.toml, load_cell\.zero_stability: is 0\.2"):
        read_rig_data([tmp_path])


def test_missing_time_in_one_file_is_noted(tmp_path):
    write(tmp_path, given_slip(), "a.csv")
    write(tmp_path, louder(given_slip()).drop(columns="t"), "b.csv")
    data = read_rig_data([tmp_path])
    assert data.samples.time is None
    assert "1 of 2 files have no time: no times are used" in data.notes


def test_comments_and_blank_lines_are_no_rows(tmp_path):
    text = "# bench 3\n\n" + given_slip().to_csv(index=False).replace("\n", "\n\n")
    (tmp_path / "rig.csv").write_text(text)
    assert len(read_rig_data([tmp_path]).samples) == N


def test_numbers_survive_to_the_last_bit(tmp_path):
    rng = np.random.default_rng(0)
    table = given_slip().assign(traction_force=rng.normal(size=N))
    with gzip.open(tmp_path / "a.csv.gz", "wt") as file:
        table.to_csv(file, index=False)
    read = read_rig_data([tmp_path]).samples.traction_force
    np.testing.assert_array_max_ulp(read, table.traction_force.to_numpy(), 1)


def test_unknown_slip_definition_is_a_settings_error(tmp_path):
    with pytest.raises(SettingsError, match="did you mean 'travel'"):
        read_rig_data([write(tmp_path, given_slip())], slip_definition="travle")


def test_table_without_any_condition_met_is_an_error(tmp_path):
    columns(tmp_path, "rows.keep = ['t > 100']")
    with pytest.raises(DataError, match=r"no row of 40 is left by \[rows\] keep: t > 100"):
        read_rig_data([write(tmp_path, given_slip())])
