# SPDX-License-Identifier: MIT
"""What recording promises, held for long and killed often; the tables are printed."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from rig.backends import open_rig
from rig.slip_rig.decode import decode_board
from zebro_lab.raw_log import read_raw_log
from zebro_lab.run_folder import read_slip_rig_run
from zebro_lab.stages.runs import list_runs

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))
KILLS = int(os.environ.get("ZEBRO_LAB_KILLS", "20"))
SOAK = float(os.environ.get("ZEBRO_LAB_SOAK", "600"))

pytestmark = pytest.mark.long


def tell(line):
    print(line, flush=True)  # noqa: T201 the table is what `make test-long` is run for


def recording(data, *, label):
    return subprocess.Popen(
        [COMMAND, "record", "--zebro", "sim", "--imu", "sim", "--rig", "sim", "--label", label,
         "--data", str(data)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def begun(data, label):
    """Wait for a run's log and return it, with the host time at which the run began."""
    end = time.monotonic() + 30
    while time.monotonic() < end:
        for log in data.glob(f"*_{label}/log.mcap"):
            streams = read_raw_log(log).streams if (log.parent / "run.json").is_file() else {}
            if "/load_cell/raw" in streams:
                return log
        time.sleep(0.05)
    raise AssertionError("nothing was recorded")


def test_killed_at_any_time_a_run_lacks_at_most_a_fifth_of_a_second(tmp_path):
    rng = np.random.default_rng(4)
    missing = []
    for kill in range(KILLS):
        process = recording(tmp_path, label=f"kill{kill}")
        log = begun(tmp_path, f"kill{kill}")
        time.sleep(rng.uniform(0.0, 2.0))
        killed = time.time_ns()
        process.send_signal(signal.SIGKILL)
        process.communicate()
        started = np.datetime64(
            json.loads((log.parent / "run.json").read_text())["start"][:-6], "ns"
        )
        last = read_raw_log(log).streams["/load_cell/raw"].host_time[-1]
        missing.append((killed - started.astype(int)) / 1e9 - last)
        run = read_slip_rig_run(log.parent)
        assert len(run.table) > 100
        os.utime(log, (0, 0))
    assert {run.state for run in list_runs(tmp_path)} == {"recovered"}
    tell(
        f"\n{KILLS} kills: missing {1e3 * np.median(missing):.0f} ms in the median, "
        f"{1e3 * max(missing):.0f} ms at most"
    )
    assert max(missing) <= 0.2


def test_a_calibration_takes_runs_that_were_killed(tmp_path):
    process = recording(tmp_path, label="killed")
    log = begun(tmp_path, "killed")
    time.sleep(8.0)
    process.kill()
    process.communicate()
    fitted = subprocess.run(
        [COMMAND, "calibrate", str(log.parent), "--out", str(tmp_path / "calibration"),
         "--max-steps", "200"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert fitted.returncode in (0, 3), fitted.stderr
    assert "cut short" in fitted.stdout
    assert (tmp_path / "calibration" / "slip.toml").is_file()


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_driver_that_is_gone_leaves_no_disc_turning(number):
    twin = subprocess.Popen([COMMAND, "sim", "rig", "--socket"], stdout=subprocess.PIPE, text=True)
    try:
        address = f"rig-board-serial@{twin.stdout.readline().split()[-1]}"
        driver = subprocess.Popen(
            [sys.executable, "-c", DRIVE, address], stdout=subprocess.PIPE, text=True
        )
        assert driver.stdout.readline() == "turning\n"
        time.sleep(0.3)
        driver.send_signal(number)
        driver.communicate()
        time.sleep(0.8)
        board = open_rig(address).board
        with board:
            samples = []
            while len(samples) < 50:
                samples += board.read(0.5)
        _, speeds = decode_board(board.profile, samples)
        assert abs(speeds.leg[-1]) < 0.1
    finally:
        twin.kill()
        twin.communicate()


DRIVE = """
import signal
import sys
signal.signal(signal.SIGINT, lambda *_: sys.exit())
from rig.backends import open_rig
from rig.device import iterate
board = open_rig(sys.argv[1]).board
with board:
    board.leg.arm(1.0)
    board.leg.set_speed(12.0)
    for _ in iterate(board, duration=0.5):
        pass
    print("turning", flush=True)
    for _ in iterate(board, duration=60.0):
        pass
"""


def test_nothing_is_lost_in_the_host_at_full_rate_for_long(tmp_path):
    sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
    try:
        from recording_bench import measure, report
    finally:
        sys.path.pop(0)
    manifest, share, size = measure(SOAK, tmp_path)
    tell(f"\n{SOAK:g} s:")
    report(manifest, share, size)
    for name, counters in manifest.counters.items():
        assert counters["received"] == manifest.streams[f"/{name}/raw"]
        assert {k: v for k, v in counters.items() if k != "received" and v} == {}
