# SPDX-License-Identifier: MIT
"""Tables of every accepted form become the same samples."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip import convert_slip
from support.rig_tables import RADII, N, columns, given_slip, louder, speeds, write
from support.table_runs import slip_rig_run
from support.written_runs import START, edit, make_run
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.runs.slip_rig_table import SlipRigTable


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
    assert plain.notes[0] == "slip computed from disc speeds and radii, definition material"
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


@pytest.mark.parametrize("definition", ["material", "travel", "larger"])
def test_asked_definition_is_reached_from_speeds_and_from_given_slip(tmp_path, plain, definition):
    for number, table in enumerate((speeds(), given_slip("travel"), given_slip("larger"))):
        folder = tmp_path / str(number)
        columns(folder, RADII)
        data = read_rig_data([write(folder, table)], slip_definition=definition)
        assert data.samples.definition == definition
        expected = convert_slip(plain.samples.slip, "material", definition)
        np.testing.assert_allclose(data.samples.slip, expected, atol=1e-12)


def test_slip_over_the_mean_speed_is_fitted_as_material_slip(tmp_path, plain):
    data = read_rig_data([write(tmp_path, given_slip("mean"))])
    assert data.samples.definition == "material"
    np.testing.assert_allclose(data.samples.slip, plain.samples.slip, atol=1e-12)


def test_each_file_is_a_run_by_default(tmp_path):
    columns(tmp_path, RADII)
    write(tmp_path / "b", speeds())
    write(tmp_path / "a", louder(speeds()))
    data = read_rig_data([tmp_path])
    assert data.samples.n_runs == 2
    assert data.samples.run_names == (str(Path("a", "rig")), str(Path("b", "rig")))
    assert "2 runs, each file is one run" in data.notes


def test_nearest_columns_file_wins_and_an_explicit_one_over_all(tmp_path):
    columns(tmp_path, "source = 'real'")
    path = write(tmp_path / "below" / "deep", given_slip())
    assert read_rig_data([tmp_path]).source == "real"
    assert read_rig_data([path]).source == "real"  # also where the folder above was not named
    columns(tmp_path / "below", "source = 'sim:a'")
    assert read_rig_data([tmp_path]).source == "sim:a"
    elsewhere = columns(tmp_path / "elsewhere", "source = 'sim:b'")
    data = read_rig_data([path], columns=elsewhere)
    assert data.source == "sim:b"
    assert data.files == (path, elsewhere)


def test_columns_above_the_named_folder_are_noted_once_for_a_folder(tmp_path):
    file = columns(tmp_path, RADII)
    for number, table in enumerate((speeds(), louder(speeds()))):
        write(tmp_path / "below", table, f"{number}.csv")
    line = f"0.csv: columns are those of {file}, the nearest for rig above it"
    assert [n for n in read_rig_data([tmp_path / "below"]).notes if "above" in n] == [line]
    assert not any("above" in note for note in read_rig_data([tmp_path]).notes)
    override = read_rig_data([tmp_path / "below"], columns=file)
    assert not any("above" in note for note in override.notes)


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


def test_results_among_the_data_are_passed_over(tmp_path):
    path = write(tmp_path, given_slip())
    write(tmp_path / "walk", pd.DataFrame({"t": [0.0], "x": [0.0]}), "path.csv")
    (tmp_path / "walk" / "manifest.json").write_text('{"schema":1,"kind":"walk","outputs":{}}')
    assert read_rig_data([tmp_path]).files == (path,)
    with pytest.raises(DataError, match=r"result of a command .kind 'walk'"):
        read_rig_data([tmp_path / "walk"])


@pytest.fixture
def mixed(tmp_path):
    """A folder with a rig run, an excluded one, one that was cut short at once, and a walk."""
    data = tmp_path / "DATA"
    runs = {
        name: make_run(data, n, label=name, start=START + timedelta(minutes=n))
        for name, n in (("good", 200), ("bad", 201), ("cut", 202), ("walked", 203))
    }
    edit(runs["bad"], excluded={"why": "belt"})
    edit(runs["cut"], exit_status="recording", log_sha256=...)
    (runs["cut"] / "log.mcap").write_bytes((runs["cut"] / "log.mcap").read_bytes()[:300])
    edit(runs["walked"], kind="walk")
    return data, runs


def test_of_a_mixed_folder_only_the_rigs_good_runs_count_and_the_rest_is_named(mixed):
    data, runs = mixed
    read = read_rig_data([data])
    assert read.samples.run_names == (runs["good"].name,)
    others, excluded, cut = (note for note in read.notes if "left out" in note)
    assert others == f"left out, runs of another kind than slip-rig: {runs['walked'].name} (walk)"
    assert excluded == f"{runs['bad'].name}: left out, belt"
    assert cut.startswith(f"{runs['cut'].name}: left out, its recording was cut short")


def test_a_run_that_ended_is_not_left_out_for_its_damage(mixed):
    data, runs = mixed
    edit(runs["cut"], exit_status="completed")
    with pytest.raises(DataError, match="no samples of topic"):
        read_rig_data([data])


def test_walks_alone_are_no_rig_data(mixed):
    _, runs = mixed
    with pytest.raises(
        DataError, match=r"no rig data, only runs of another kind.*calibrate-slip DATA --walks RUN"
    ):
        read_rig_data([runs["walked"]])


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
    assert "1 of 2 files have no time, so none is used" in data.notes


def test_unknown_slip_definition_is_a_settings_error(tmp_path):
    with pytest.raises(SettingsError, match="did you mean 'travel'"):
        read_rig_data([write(tmp_path, given_slip())], slip_definition="travle")
