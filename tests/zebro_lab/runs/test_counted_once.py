# SPDX-License-Identifier: MIT
"""The same data under two names count once, and a note says so."""

import gzip
import shutil
from datetime import UTC, datetime
from pathlib import Path

import pandas as pd
import pytest

from support.table_runs import sweep_runs
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.runs.counted_once import content_hash
from zebro_lab.runs.exclusion import exclude_run

START = datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)


@pytest.fixture
def data(sweep, tmp_path) -> Path:
    """Return a folder with the sweep's table and its columns.toml."""
    shutil.copytree(sweep, tmp_path / "data")
    return tmp_path / "data"


def runs_of(folder: Path, data: Path, **settings) -> list[Path]:
    table = pd.read_csv(folder / "sweep.csv")
    return sweep_runs(data, table, **settings)


def assert_once(found: RigData, sweep: Path, *names: str) -> None:
    alone = read_rig_data([sweep])
    assert len(found.samples.run_names) == len(alone.samples.run_names)
    assert len(found.samples) == len(alone.samples)
    told = [note for note in found.notes if "duplicate" in note]
    assert len(told) == 1
    assert all(name in told[0] for name in names)


def as_copy(file: Path) -> Path:
    return shutil.copy(file, file.with_name("copy.csv"))


def as_gzip(file: Path) -> Path:
    packed = file.with_name("packed.csv.gz")
    packed.write_bytes(gzip.compress(file.read_bytes()))
    return packed


def as_parquet(file: Path) -> Path:
    table = file.with_name("table.parquet")
    pd.read_csv(file).to_parquet(table)
    return table


@pytest.mark.parametrize("again", [as_copy, as_gzip, as_parquet])
def test_a_table_under_two_names_counts_once(data, sweep, again):
    again(data / "sweep.csv")
    assert_once(read_rig_data([data]), sweep, "sweep")


@pytest.mark.parametrize("name", ["sweep - Kopie", "sweep (1)", "sweep copy", "Copy of sweep"])
def test_of_two_equal_tables_the_one_named_like_a_copy_is_the_copy(data, name):
    table = data / "sweep.csv"
    found = read_rig_data([shutil.copy(table, data / f"{name}.csv"), table])
    assert found.files[0] == table
    assert f"{name} equals sweep" in found.repeated[0]


@pytest.mark.parametrize("again", [START, START.replace(year=2027), None])
def test_runs_written_or_copied_again_count_once(sweep, tmp_path, again):
    folder = runs_of(sweep, tmp_path / "runs", start=START, label="first")[0]
    if again is None:
        shutil.copytree(folder, tmp_path / "runs" / "again")
    else:
        runs_of(sweep, tmp_path / "runs", start=again, label="again")
    assert_once(read_rig_data([tmp_path / "runs"]), sweep, "again")


def test_a_table_beside_runs_with_its_samples_counts_once(data, sweep):
    runs_of(data, data / "runs", start=START)
    assert_once(read_rig_data([data]), sweep, "sweep")


def test_what_is_excluded_does_not_come_back_under_another_name(data, sweep):
    folder = runs_of(data, data / "runs", start=START)[3]
    exclude_run(folder, why="belt slipped")
    found = read_rig_data([data])
    alone = read_rig_data([sweep])
    assert len(found.samples.run_names) == len(alone.samples.run_names) - 1


def test_repeated_rows_within_one_table_are_its_own(tmp_path):
    trials = "slip_ratio,normal_force,traction_force\n" + "".join(
        f"{0.01 * i},5,{min(1.0, 0.1 * i)}\n" * 2 for i in range(1, 11)
    )
    (tmp_path / "trials.csv").write_text(trials)
    (tmp_path / "columns.toml").write_text(
        "[columns.slip_ratio]\nname = 'slip_ratio'\ndefinition = 'material'\n"
        "[runs]\neach_row = true\n"
    )
    assert len(read_rig_data([tmp_path]).samples) == 20


def test_a_damaged_gzip_file_is_told_apart_by_its_bytes(tmp_path):
    packed = gzip.compress(b"t,x\n" * 1000)
    whole, cut = tmp_path / "a.csv.gz", tmp_path / "b.csv.gz"
    whole.write_bytes(packed)
    cut.write_bytes(packed[:-9])
    (tmp_path / "c.csv").write_bytes(b"t,x\n" * 1000)
    assert content_hash(whole) == content_hash(tmp_path / "c.csv") != content_hash(cut)
