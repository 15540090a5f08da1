# SPDX-License-Identifier: MIT
"""Whichever call of the disk fails: no recording is completed that is not whole, and all agree."""

import errno
from itertools import count

import pytest

from support.failing_disks import ERRORS, KINDS, FailingDisk
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.folder import find_runs, require_recorded
from zebro_lab.runs.manifest import read_manifest


@pytest.fixture
def fails(tmp_path, run_command):
    """Return what records while the n-th call of a kind fails; it returns whether that came."""

    def record(kind, number, error, **more):
        data = tmp_path / f"{kind}{number}{error}"
        with pytest.MonkeyPatch.context() as patch:
            disk = FailingDisk(patch, data, kind, number, error, **more)
            ended = run_command("record", "--zebro", "sim", "--label", "x", "--duration", "0.2",
                                "--data", data)  # fmt: skip
        runs = find_runs(data) if data.is_dir() else []
        states = [read_manifest(run).exit_status for run in runs]
        if ended.code == 0:
            assert states == ["completed"]
            assert read_raw_log(runs[0] / "log.mcap").damage is None
            require_recorded(runs[0] / "log.mcap", read_manifest(runs[0]))
        else:
            assert ended.code == 1
            assert ended.err.splitlines()[-1].startswith("error"), ended.err
            assert "completed" not in states
        return disk.failed

    return record


@pytest.mark.parametrize(
    ("kind", "number", "name"),
    [("fsync", 1, "log.mcap"), ("write", 2, "log.mcap"), ("replace", 2, "run.json")],
)
def test_a_disk_that_fails_completes_no_recording(fails, kind, number, name):
    assert fails(kind, number, errno.EIO, name=name)


@pytest.mark.long
@pytest.mark.parametrize("error", ERRORS, ids=errno.errorcode.get)
@pytest.mark.parametrize("kind", KINDS)
def test_no_call_that_fails_leaves_a_completed_recording_in_part(fails, kind, error):
    assert next(number for number in count(1) if not fails(kind, number, error)) > 1
