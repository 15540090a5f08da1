# SPDX-License-Identifier: MIT
"""Leg angles, roll and pitch of a recorded run are those that its picture shows."""

import shutil

import numpy as np
import pytest

from support.written_runs import make_run
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.provenance import file_hash
from zebro_lab.runs.exclusion import exclude_run, take_in_again
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.recorded_walk import is_recorded, read_recorded_legs, read_recorded_tilt
from zebro_lab.runs.signals import read_signals


@pytest.fixture
def folder(recorded, tmp_path):
    """Return a copy of the recorded run that a test may damage."""
    return shutil.copytree(recorded, tmp_path / recorded.name)


def test_angles_are_unwrapped_at_increasing_times(recorded):
    table, files = read_recorded_legs(recorded)
    assert list(table.columns) == ["t", *(f"theta{leg}" for leg in range(1, 7))]
    t = table.numbers("t")
    assert np.all(np.diff(t) > 0)
    shown = next(p for p in read_signals(recorded).panels if p.title == "legs: angles, unwrapped")
    for leg in range(1, 7):
        expected = np.interp(t, shown.t, shown.lines[f"leg {leg}"])
        np.testing.assert_allclose(table.numbers(f"theta{leg}"), expected, atol=1e-12)
    assert [file.name for file in files] == ["log.mcap", "legs.toml", "run.json"]
    assert (table.source, table.notes) == ("sim:zebro", ())
    assert is_recorded(recorded)
    assert not is_recorded(recorded.parent)


def test_a_log_cut_short_is_read_so_far_with_a_note(folder):
    log = folder / "log.mcap"
    log.write_bytes(log.read_bytes()[: log.stat().st_size // 2])
    table, _ = read_recorded_legs(folder)
    assert len(table) > 10
    assert "log.mcap is incomplete" in table.notes[0]


def test_the_first_file_read_tells_a_walk_also_after_it_was_excluded_for_a_while(folder):
    hashes = [file_hash(file) for file in read_recorded_legs(folder)[1]]
    exclude_run(folder, why="a trial")
    take_in_again(folder)
    again = [file_hash(file) for file in read_recorded_legs(folder)[1]]
    assert again[0] == hashes[0]
    assert again[-1] != hashes[-1]


@pytest.mark.parametrize("name", ["log.mcap", "profiles/legs.toml"])
def test_a_missing_file_is_named(folder, name):
    (folder / name).unlink()
    with pytest.raises(NotFound, match=f"{name}: missing"):
        read_recorded_legs(folder)


def test_a_damaged_profile_and_a_run_without_legs_are_named(folder, tmp_path):
    (folder / "profiles" / "legs.toml").write_text("schema = 99")
    with pytest.raises(DataError, match=r"legs\.toml"):
        read_recorded_legs(folder)
    rig = make_run(tmp_path)
    (rig / "profiles" / "legs.toml").write_text("")
    with pytest.raises(DataError, match="no samples of topic /legs/raw"):
        read_recorded_legs(rig)


def test_roll_and_pitch_are_in_radians_at_increasing_times(recorded):
    tilt = read_recorded_tilt(recorded)
    assert np.all(np.diff(tilt.t) > 0)
    shown = next(p for p in read_signals(recorded).panels if p.title == "imu: orientation")
    for values, name in zip(tilt.angles.T, ("roll", "pitch"), strict=True):
        degrees = np.interp(tilt.t, shown.t, shown.lines[name])
        np.testing.assert_allclose(np.degrees(values), degrees, atol=1e-9)
    assert [file.name for file in tilt.files] == ["log.mcap", "imu.toml"]
    assert tilt.source == read_manifest(recorded).sources["imu"]


def test_a_run_without_an_imu_or_log_has_no_tilt(recorded, tmp_path):
    assert read_recorded_tilt(make_run(tmp_path)) is None
    folder = shutil.copytree(recorded, tmp_path / "copy")
    (folder / "log.mcap").unlink()
    assert read_recorded_tilt(folder) is None


def test_a_damaged_profile_of_an_imu_is_named(recorded, tmp_path):
    folder = shutil.copytree(recorded, tmp_path / "copy")
    (folder / "profiles" / "imu.toml").write_text("schema = 99")
    with pytest.raises(DataError, match=r"imu\.toml"):
        read_recorded_tilt(folder)


def with_a_second(recorded, folder, profile):
    """Copy a run so that its IMU is one of two."""
    shutil.copytree(recorded, folder)
    shutil.copy(folder / "profiles" / "imu.toml", folder / "profiles" / f"{profile}.toml")
    return folder


@pytest.mark.parametrize("other", ["imu2", "imu0"])  # neither has sent anything
def test_of_two_imus_the_one_that_is_used_and_the_other_are_named(recorded, tmp_path, other):
    tilt = read_recorded_tilt(with_a_second(recorded, tmp_path / "two", other))
    assert [file.name for file in tilt.files] == ["log.mcap", "imu.toml"]
    assert tilt.notes == (f"roll and pitch are those of imu; not used: {other}",)
    assert read_recorded_tilt(recorded).notes == ()
