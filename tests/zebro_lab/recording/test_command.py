# SPDX-License-Identifier: MIT
"""`zebro-lab record` and `runs` as their user meets them, also where a recording is ended."""

import json
import os
import re
import signal
import sys

import pytest

from support.commands import started
from support.recorders import growing
from zebro_lab.mcap.raw_log import read_raw_log


def test_a_recording_prints_counts_clocks_and_folder_and_is_listed(run_command, tmp_path):
    options = ("--zebro", "sim", "--duration", 1.0, "--label", "first")
    code, out, err = run_command("record", "--data", tmp_path, *options)
    assert (code, err) == (0, "")
    assert re.search(
        r"SIMULATED legs: \d+ samples received, 0 lost.*, 0 rejected.*, 0 dropped", out
    )
    assert "clock of legs: its pace is not testable in so short a time" in out
    (folder,) = tmp_path.iterdir()
    assert f"recording completed; run folder {folder}" in out
    code, out, _ = run_command("runs", tmp_path)
    assert code == 0
    assert re.search(r"_walk_first  completed  \d\.\d s  \d+ /legs/raw  SIMULATED sim:zebro", out)
    assert "1 run in" in out


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_recording_with_a_complete_record(number, tmp_path):
    with started("record", "--zebro", "sim", "--label", "x", "--data", tmp_path) as process:
        folder = growing(tmp_path)
        process.send_signal(number)
        _, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (130, "")
    manifest = json.loads((folder / "run.json").read_text())
    assert manifest["exit_status"] == f"stopped: {number.name}"
    assert manifest["log_sha256"]
    assert manifest["counters"]["legs"]["received"] == manifest["streams"]["/legs/raw"]
    assert read_raw_log(folder / "log.mcap").damage is None


def test_a_killed_recording_is_recovered(run_command, tmp_path):
    with started("record", "--zebro", "sim", "--label", "x", "--data", tmp_path) as process:
        folder = growing(tmp_path)
        process.kill()
        process.wait(20)
    assert read_raw_log(folder / "log.mcap").streams["/legs/raw"]
    os.utime(folder / "log.mcap", (0, 0))
    assert "  recovered  " in run_command("runs", tmp_path)[1]


@pytest.mark.skipif(sys.platform == "win32", reason="limits of a process")
def test_a_disk_that_takes_no_more_ends_a_recording_with_its_record(run_command, tmp_path):
    import resource

    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

    with started(
        "record", "--rig", "sim", "--label", "x", "--data", tmp_path, preexec_fn=limited
    ) as process:
        _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "recording ended early" in err
    assert err.count("\n") == 1
    (folder,) = tmp_path.iterdir()
    manifest = json.loads((folder / "run.json").read_text())
    assert manifest["exit_status"].startswith("failed: ")
    assert "log_sha256" not in manifest
    assert len(read_raw_log(folder / "log.mcap").streams["/load_cell/raw"]) > 100


ERRORS = {
    "no such port": (("--label", "x", "--zebro", "zebro-100-serial@/dev/no"), "cannot open port"),
    "no such profile": (("--label", "x", "--imu", "mine@sim"), "neither a file 'mine' nor a"),
    "nobody to play to": (("--label", "x", "--imu", "sim", "--play", "legs.csv"), "legs.csv"),
}


@pytest.mark.parametrize(("options", "message"), ERRORS.values(), ids=ERRORS)
def test_an_error_is_one_line_and_nothing_is_written(options, message, run_command, tmp_path):
    code, out, err = run_command("record", "--data", tmp_path / "data", *options)
    assert (code, out) == (1, "")
    assert message in err
    assert err.count("\n") == 1
    assert not (tmp_path / "data").exists()
