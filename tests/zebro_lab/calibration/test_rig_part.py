# SPDX-License-Identifier: MIT
"""One table or run folder becomes samples in SI, with its runs apart."""

from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from model.slip import SlipDefinition, convert_slip
from support.rig_tables import RADII, N, columns, given_slip, speeds, write
from support.table_runs import slip_rig_run
from support.written_runs import edit
from zebro_lab.calibration.rig_part import (
    RigPart,
    joined_samples,
    read_part,
    recorded_sweeps,
)
from zebro_lab.files.errors import DataError
from zebro_lab.runs.data_paths import DataSource
from zebro_lab.runs.folder import SlipRigRun
from zebro_lab.runs.slip_rig_table import SlipRigTable
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.rig_columns import RigColumns

TWICE = '[columns.normal_force]\nname = "FZ"\nunit = "kN"\nsign = -1\n[runs]\nby = ["day"]\n'


def part_of(path, *, mapped: RigColumns | None = None, wanted=None) -> RigPart:
    return read_part(DataSource(path, path.parent), mapped or RigColumns(), "rig", wanted)


@pytest.fixture
def two_runs(tmp_path) -> RigPart:
    """Return a table of two days, its normal force in kN and of the other sign."""
    table = speeds().assign(day=np.repeat(["mon", "tue"], [20, 20]))
    table["FZ"] = -table.pop("normal_force") / 1e3
    mapped = read_columns(columns(tmp_path, TWICE + RADII))
    return part_of(write(tmp_path, table), mapped=mapped)


def test_columns_are_converted_and_every_file_and_conversion_is_told(two_runs, tmp_path):
    np.testing.assert_allclose(two_runs.normal_force, speeds().normal_force)
    np.testing.assert_allclose(two_runs.traction_force, speeds().traction_force)
    np.testing.assert_allclose(two_runs.time, speeds().t)
    np.testing.assert_allclose(two_runs.slip.ratio, np.linspace(0.0, 0.5, N), atol=1e-12)
    assert two_runs.files == (tmp_path / "rig.csv", tmp_path / "columns.toml")
    assert two_runs.notes == ("normal_force: 'FZ' in kN times -1000",)
    assert (two_runs.rows_read, two_runs.sources) == (N, ())


def test_radii_say_how_wrong_slip_may_be_from_constants_or_columns(tmp_path, two_runs):
    apart = speeds().assign(radius_leg=0.035, radius_ground=0.12)
    in_columns = part_of(write(tmp_path, apart))
    assert in_columns.rig_errors == two_runs.rig_errors
    assert two_runs.rig_errors.radius_ratio == pytest.approx(1e-4 * np.hypot(1 / 0.035, 1 / 0.12))


def test_a_given_slip_without_radii_may_be_one_percent_wrong(tmp_path):
    assert part_of(write(tmp_path, given_slip())).rig_errors.radius_ratio == 0.01


def test_a_chosen_run_is_kept_whole_and_alone(two_runs):
    chosen = two_runs.with_runs(np.array([False, True]))
    assert chosen.runs.names == two_runs.runs.names[1:]
    assert set(chosen.runs.index) == {0}
    for name in ("normal_force", "traction_force", "time"):
        np.testing.assert_array_equal(getattr(chosen, name), getattr(two_runs, name)[20:])
    np.testing.assert_array_equal(chosen.slip.ratio, two_runs.slip.ratio[20:])
    assert chosen.rows_read == 20
    assert chosen.keys == two_runs.keys[1:]
    assert two_runs.with_runs(np.array([True, True])).keys == two_runs.keys


def test_a_part_without_times_has_none_after_choosing_either(tmp_path):
    part = part_of(write(tmp_path, given_slip().drop(columns="t")))
    assert part.time is None
    assert part.with_runs(np.array([True])).time is None


@pytest.mark.parametrize("wanted", [None, *SlipDefinition])
def test_given_slip_keeps_its_definition_unless_another_is_wanted(tmp_path, wanted):
    part = part_of(write(tmp_path, given_slip("travel")), wanted=wanted)
    assert part.slip.definition == (wanted or "travel")
    expected = convert_slip(np.linspace(0.0, 0.5, N), "material", wanted or "travel")
    np.testing.assert_allclose(part.slip.ratio, expected, atol=1e-12)


def test_unused_columns_are_offered_where_they_differ_between_runs_and_follow_no_used_one(tmp_path):
    rng, run = np.random.default_rng(1), np.repeat(np.arange(8), 5)
    table = given_slip("material").assign(run=run, operator="a")
    table["normal_force"] = 5.0 + rng.permutation(8)[run]
    table = table.assign(
        room=20 + rng.permutation(8)[run], jitter=rng.standard_normal(N),
        mu=table["traction_force"] / table["normal_force"], force_kN=table["traction_force"] / 1e3,
        percent=100 * table["slip_ratio"], weight=9.81 * table["normal_force"], fixed=3.0,
    )  # fmt: skip
    mapped = read_columns(columns(tmp_path, '[runs]\nby = ["run"]\n'))
    part = part_of(write(tmp_path, table), mapped=mapped)
    found = joined_samples([part]).others
    assert list(found) == ["room"]
    np.testing.assert_array_equal(found["room"], table["room"])
    chosen = part.with_runs(np.arange(8) > 3)
    assert (
        joined_samples([part, chosen]).others["room"].tolist()[-20:] == table["room"].tolist()[20:]
    )
    bare = part_of(write(tmp_path / "bare", table.drop(columns="room")), mapped=mapped)
    assert joined_samples([part, bare]).others == {}


def test_a_run_folder_is_read_by_its_own_constants_whatever_the_map_says(tmp_path):
    table = SlipRigTable(*speeds().to_numpy().T)
    folder = slip_rig_run(
        tmp_path / "DATA", table, label="rig", material="steel", operator="a", source="sim:test",
        start=datetime(2026, 1, 2, tzinfo=UTC), radius_leg=0.035, radius_ground=0.12,
    )  # fmt: skip
    text = 'source = "real"\nrows.keep = ["t >= 0.04"]\n[columns]\nt = "no such"\n'
    mapped = read_columns(columns(tmp_path, text))
    part = part_of(folder, mapped=mapped)
    np.testing.assert_allclose(part.slip.ratio, np.linspace(0.0, 0.5, N)[10:], atol=1e-12)
    assert part.sources == ("sim:test",)
    assert part.rows_read == N
    assert part.runs.names == ("rig",)
    assert set(part.files) == {folder / "run.json", folder / "log.mcap", tmp_path / "columns.toml"}


def test_a_recorded_run_is_one_run_a_sweep(tmp_path):
    t = np.arange(0.0, 6.0, 0.005)
    leg = np.full_like(t, 12.0)
    ground = (1 - 0.9 * (t % 2.0) / 2.0) * leg * 0.035 / 0.12
    table = SlipRigTable(t, leg, ground, np.full_like(t, 5.0), np.full_like(t, 1.0))
    folder = slip_rig_run(
        tmp_path, table, label="rig", material="steel", operator="a", source="sim:test",
        start=datetime(2026, 1, 2, tzinfo=UTC), radius_leg=0.035, radius_ground=0.12,
    )  # fmt: skip
    assert len(part_of(folder).runs.names) == 1  # a table was cut into runs before
    edit(folder, profiles={"rig": "of-the-bench"})
    part = part_of(folder)
    assert len(part.runs.names) == 3
    assert part.rows_read == len(part.normal_force) < len(t)
    assert "of the samples are ignored, because slip jumped" in part.notes[0]


T = np.arange(0.0, 6.0, 0.005)
DISCS = {"radius_leg": 0.035, "radius_ground": 0.12}


def run(slip: np.ndarray, omega_leg: float = 12.0) -> SlipRigRun:
    leg = np.full_like(T, omega_leg)
    ground = (1 - slip) * leg * DISCS["radius_leg"] / DISCS["radius_ground"]
    table = SlipRigTable(T, leg, ground, np.full_like(T, 5.0), np.full_like(T, 1.0))
    return SlipRigRun(Path("a-run"), SimpleNamespace(constants=DISCS), table, ())


def test_sweeps_are_numbered_from_one_and_jumps_belong_to_none():
    number, (note,) = recorded_sweeps(run(0.9 * (T % 2.0) / 2.0))
    assert [int(number[np.searchsorted(T, t)]) for t in (1.0, 3.0, 5.0)] == [1, 2, 3]
    between = (number == 0) & (T > 0.5) & (T < 5.5)
    assert np.all(np.abs((T[between] + 1) % 2.0 - 1) < 0.5)
    left_out = np.mean(number == 0)
    assert 0 < left_out < 0.4
    assert note == (f"a-run: {left_out:.1%} of the samples are ignored, because slip jumped "
                    "between two sweeps or the leg disc stood still")  # fmt: skip


def test_one_sweep_is_kept_whole_without_a_note():
    number, notes = recorded_sweeps(run(T / 10))
    assert set(number) == {1}
    assert notes == ()


def test_a_disc_that_never_turns_is_named():
    with pytest.raises(DataError, match=r"a-run.log\.mcap: the leg disc never turned"):
        recorded_sweeps(run(np.zeros_like(T), omega_leg=0.0))
