# SPDX-License-Identifier: MIT
"""`zebro-lab record` and `runs` as their user meets them, also where a recording is ended."""

import contextlib
import json
import os
import re
import signal
import sys
import termios

import numpy as np
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
    assert "clock of legs: " in out
    (folder,) = tmp_path.iterdir()
    assert f"recording completed; run folder {folder}" in out
    code, out, _ = run_command("runs", tmp_path)
    assert code == 0
    assert re.search(r"_walk_first  completed  \d\.\d s  \d+ /legs/raw  SIMULATED sim:zebro", out)
    assert "1 run in" in out


def recording(data, *options, **given):
    """Record the simulated robot in a process of its own, which the end of the body kills."""
    fixed = ("record", "--zebro", "sim", "--label", "x", "--data", data)
    return started(*fixed, *options, **given)


def require_whole(folder):
    """Check that a run ended with its record, its whole log, and nothing lost."""
    record = json.loads((folder / "run.json").read_text())
    assert record["log_sha256"]
    assert record["counters"]["legs"]["lost"] == 0
    assert record["counters"]["legs"]["dropped"] == 0
    assert record["counters"]["legs"]["received"] == record["streams"]["/legs/raw"]
    assert read_raw_log(folder / "log.mcap").damage is None
    return record


@pytest.mark.parametrize(
    ("number", "heard"),
    [(signal.SIGINT, True), (signal.SIGTERM, True), (signal.SIGTERM, False)],
)
def test_a_signal_ends_a_recording_with_a_complete_record(number, heard, tmp_path):
    """That nobody hears its last words changes neither its record nor its exit code."""
    with recording(tmp_path) as process:
        folder = growing(tmp_path)
        if not heard:
            process.stdout.close()
            process.stdout = None
        process.send_signal(number)
        _, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (130, "")
    assert require_whole(folder)["exit_status"] == f"stopped: {number.name}"


def test_a_killed_recording_is_recovered(run_command, tmp_path):
    with recording(tmp_path) as process:
        folder = growing(tmp_path)
        process.kill()
        process.wait(20)
    assert read_raw_log(folder / "log.mcap").streams["/legs/raw"]
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


@contextlib.contextmanager
def terminal():
    """Open a terminal: the side of the person, and the side of programs."""
    master, slave = os.openpty()
    termios.tcsetwinsize(slave, (24, 100))
    sides = {master, slave}
    try:
        yield master, slave, sides
    finally:
        for side in sides:
            os.close(side)


@pytest.mark.parametrize("when", ["before", "while"])
def test_a_stopped_terminal_holds_up_no_recording(tmp_path, when):
    with terminal() as (_, slave, _sides):
        if when == "before":
            termios.tcflow(slave, termios.TCOOFF)
        given = {"stdin": slave, "stdout": slave, "stderr": slave}
        with recording(tmp_path, "--duration", "1", **given) as process:
            folder = growing(tmp_path)
            termios.tcflow(slave, termios.TCOOFF)
            process.wait(15)
        assert process.returncode == 0
        termios.tcflow(slave, termios.TCOON)
    lasted = np.ptp(read_raw_log(folder / "log.mcap").streams["/legs/raw"].host_time)
    assert 0.98 < lasted < 2.0
    record = require_whole(folder)
    assert record["exit_status"] == "completed"


def test_a_pipe_that_nobody_reads_holds_up_no_recording(tmp_path):
    reading, writing = os.pipe()
    with os.fdopen(reading), os.fdopen(writing, "wb", buffering=0) as full:
        os.set_blocking(writing, False)
        with contextlib.suppress(BlockingIOError):
            while full.write(bytes(65536)):
                pass
        os.set_blocking(writing, True)
        given = {"stdout": full, "stderr": full}
        with recording(tmp_path, "--duration", "1", **given) as process:
            folder = growing(tmp_path)  # a busy machine takes long to start a process
            process.wait(15)
    assert process.returncode == 0
    require_whole(folder)


@pytest.mark.parametrize("session", [True, False])
def test_a_closed_terminal_ends_a_recording_with_a_complete_record(tmp_path, session):
    """With a session of its own the terminal sends SIGHUP; without, only reads and writes fail."""
    with terminal() as (master, slave, sides):
        given = {"stdin": slave, "stdout": slave, "stderr": slave, "start_new_session": session}
        if session:
            import fcntl

            given["preexec_fn"] = lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0)
        with recording(tmp_path, **given) as process:
            folder = growing(tmp_path)
            for side in (slave, master):
                os.close(side)
                sides.discard(side)
            process.wait(20)
    assert process.returncode == 130
    assert require_whole(folder)["exit_status"] in ("stopped: SIGHUP", "stopped: terminal closed")
