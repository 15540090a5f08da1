# SPDX-License-Identifier: MIT
"""`zebro-lab record` in a process of its own, where folders, disks, viewers and terminals fail."""

import contextlib
import json
import os
import signal
import subprocess
import termios

import numpy as np
import pytest

from support.commands import COMMAND
from support.recorders import growing
from zebro_lab.mcap.raw_log import read_raw_log


@contextlib.contextmanager
def recording(data, *options, **given):
    """Record the simulated robot in a process of its own, which the end of the body kills."""
    given = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **given}
    given["env"] = {**given.get("env", os.environ), "PYTHONFAULTHANDLER": "1"}
    process = subprocess.Popen(
        [COMMAND, "record", "--zebro", "sim", "--label", "x", "--data", str(data), *options],
        **given,
    )
    try:
        yield process
    except AssertionError:  # show what its threads were doing
        process.send_signal(signal.SIGABRT)
        print(*process.communicate(timeout=20))  # noqa: T201 - pytest shows it
        raise
    finally:
        process.kill()
        process.communicate()


def end_record(folder):
    return json.loads((folder / "run.json").read_text())


def require_whole(folder):
    """Check that a run ended with its record, its whole log, and nothing lost."""
    record = end_record(folder)
    assert record["log_sha256"]
    assert record["counters"]["legs"]["lost"] == 0
    assert record["counters"]["legs"]["dropped"] == 0
    assert record["counters"]["legs"]["received"] == record["streams"]["/legs/raw"]
    assert read_raw_log(folder / "log.mcap").damage is None
    return record


def lasted(folder):
    return np.ptp(read_raw_log(folder / "log.mcap").streams["/legs/raw"].host_time)


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
    assert 0.98 < lasted(folder) < 2.0
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


def test_last_words_to_a_dead_pipe_change_no_exit_code(tmp_path):
    with recording(tmp_path) as process:
        folder = growing(tmp_path)
        process.stdout.close()
        process.stdout = None
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (130, b"")
    require_whole(folder)
