# SPDX-License-Identifier: MIT
"""Roll and pitch of a recorded run are those that its picture shows."""

import shutil

import numpy as np
import pytest

from support.written_runs import make_run
from zebro_lab.files.errors import DataError
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.recorded_tilt import read_recorded_tilt
from zebro_lab.runs.signals import read_signals


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


def test_a_damaged_profile_is_named(recorded, tmp_path):
    folder = shutil.copytree(recorded, tmp_path / "copy")
    (folder / "profiles" / "imu.toml").write_text("schema = 99")
    with pytest.raises(DataError, match=r"imu\.toml"):
        read_recorded_tilt(folder)


def with_a_second(recorded, folder, profile="imu2"):
    """Copy a run so that its IMU is one of two."""
    shutil.copytree(recorded, folder)
    shutil.copy(folder / "profiles" / "imu.toml", folder / "profiles" / f"{profile}.toml")
    return folder


def test_of_two_imus_the_one_that_is_used_and_the_other_are_named(recorded, tmp_path):
    tilt = read_recorded_tilt(with_a_second(recorded, tmp_path / "two"))
    assert tilt.notes == ("roll and pitch are those of imu; not used: imu2",)
    assert read_recorded_tilt(recorded).notes == ()


def test_an_imu_that_sent_nothing_is_passed_over(recorded, tmp_path):
    tilt = read_recorded_tilt(with_a_second(recorded, tmp_path / "two", "imu0"))
    assert [file.name for file in tilt.files] == ["log.mcap", "imu.toml"]
    assert tilt.notes == ("roll and pitch are those of imu; not used: imu0",)
