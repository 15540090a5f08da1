# SPDX-License-Identifier: MIT
"""Devices by their addresses: what cannot be opened leaves nothing, forces are guarded."""

import numpy as np
import pytest

from rig.device import Sample
from rig.errors import LimitExceeded, ProfileError
from rig.slip_rig.profile import load_rig_profile
from support.watchers import RecordWatcher
from zebro_lab.files.errors import SettingsError
from zebro_lab.recording.devices import ForceCheck
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.stage import record
from zebro_lab.runs.folder import read_slip_rig_run


def test_a_board_is_data_for_a_calibration(tmp_path):
    request = RecordRequest("board", tmp_path, rig="rig-board-serial@sim", duration=30.0)
    recorded = record(request, RecordWatcher(samples={"board": 600}))
    table = read_slip_rig_run(recorded.folder).table
    assert len(table) >= 600
    assert np.median(np.diff(table.t)) == pytest.approx(1e-3, rel=0.01)


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({}, SettingsError, "no device"),
        ({"rig": "sim", "duration": 0.0}, SettingsError, "expected more than 0"),
        ({"zebro": "zebro-100-serail@sim"}, ProfileError, "did you mean 'zebro-100-serial'"),
        (
            {"zebro": "zebro-100-serial@/dev/nowhere"},
            ConnectionError,
            "cannot open port /dev/nowhere: No such file or directory; check",
        ),
    ],
)
def test_what_cannot_be_recorded_leaves_nothing(tmp_path, changes, error, message):
    with pytest.raises(error, match=message):
        record(RecordRequest("x", tmp_path, **changes), RecordWatcher())
    assert list(tmp_path.iterdir()) == []


def test_a_malformed_profile_is_named_and_leaves_nothing(tmp_path):
    profile = tmp_path / "mine.toml"
    profile.write_text('schema = 1\ndevice = "legs"\n')
    with pytest.raises(ProfileError, match=r"mine\.toml"):
        record(RecordRequest("x", tmp_path / "data", zebro=f"{profile}@sim"), RecordWatcher())
    assert not (tmp_path / "data").exists()


def test_a_force_beyond_its_limit_ends_the_reading():
    profile = load_rig_profile("rig-odrive-netft")
    check, cell = ForceCheck(profile), profile.load_cell

    def weighed(*newtons):
        counts = [int(-n * cell.counts_per_force) for n in newtons]
        check([Sample(0.0, 0.0, i, (0, 0, c, 0, 0, 0)) for i, c in enumerate(counts)])

    weighed(6.0, 31.0, 31.0)
    weighed(6.0, 6.0, 6.0)
    weighed(31.0, 6.0, 31.0)
    with pytest.raises(LimitExceeded, match="normal force is 31 N; its limit is 30 N"):
        weighed(6.0, 31.0)  # three of five
