# SPDX-License-Identifier: MIT
"""A recorded run in place of a device gives the same samples, labelled as a replay."""

from datetime import UTC, datetime

import numpy as np
import pytest

from rig.errors import ProfileError
from rig.openers import resolve
from support.table_runs import slip_rig_run
from support.watchers import Onlooker
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording.devices import DevicesRequest, open_devices
from zebro_lab.recording.replayed import read_replay
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.stage import record
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.slip_rig_table import SlipRigTable


@pytest.fixture
def make(tmp_path):
    """Return a writer of rig runs of 0.2 s from a source."""

    def write(source):
        t = np.arange(100) * 2e-3
        table = SlipRigTable(t, 12 + t, 3.5 - t, 6 + np.sin(t), np.cos(t))
        return slip_rig_run(
            tmp_path / "first", table, label="a", material="", operator="", source=source,
            start=datetime(2026, 1, 1, tzinfo=UTC), radius_leg=0.035, radius_ground=0.12,
        )  # fmt: skip

    return write


def test_a_replay_is_recorded_to_the_last_sample_and_says_what_it_is(make, tmp_path):
    run = make("real")
    recorded = record(RecordRequest("b", tmp_path / "again", rig=f"replay:{run}"), Onlooker())
    assert recorded.manifest.seed is None
    assert recorded.manifest.source == f"replay:{run.name}"
    assert recorded.manifest.sources == {"board": f"replay:{run.name}"}
    assert recorded.manifest.exit_status == "completed"
    first, again = (read_raw_log(f / "log.mcap").streams["/board/raw"]
                    for f in (run, recorded.folder))  # fmt: skip
    np.testing.assert_array_equal(again.counts, first.counts)
    shift = again.host_time - first.host_time
    np.testing.assert_allclose(shift, shift[0], atol=1e-9)  # at recorded pace
    assert len(read_slip_rig_run(recorded.folder).table) == 100


def test_a_replay_of_a_simulated_run_stays_simulated(make):
    run = make("sim:noise")
    (stream,) = read_replay(f"replay:{run}", "rig").streams
    assert stream.source == f"sim:replay:{run.name}"


def test_a_stream_that_the_run_lacks_is_named(make):
    with pytest.raises(DataError, match="has no samples of legs to replay; its streams: board"):
        read_replay(f"replay:{make('real')}", "legs")


def test_a_run_that_is_not_there_or_lost_its_profile_is_named(make, tmp_path):
    with pytest.raises(NotFound, match="is not a run folder"):
        read_replay(f"replay:{tmp_path}", "rig")
    run = make("real")
    (run / "profiles" / "rig.toml").unlink()
    with pytest.raises(NotFound, match=r"rig\.toml: missing"):
        read_replay(f"replay:{run}", "rig")


def test_a_replay_moves_nothing(make):
    with pytest.raises(ProfileError, match="replays a recording"):
        resolve("replay:RUN", default="rig-board-serial")
    play = DevicesRequest(zebro=f"replay:{make('real')}", play=object())
    with pytest.raises(SettingsError, match="cannot be moved"), open_devices(play):
        pass
