# SPDX-License-Identifier: MIT
"""Roll and pitch of a recorded run are those that its picture shows."""

import shutil

import numpy as np
import pytest

from support.written_runs import make_run
from zebro_lab.files.errors import DataError
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
