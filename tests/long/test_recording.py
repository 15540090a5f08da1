# SPDX-License-Identifier: MIT
"""What recording promises, held for long and killed often; the tables are printed."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest

from benchmarks.speed.recording import measure, report
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.backends import open_rig
from rig.clock_watch import sample_times
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.slip_rig.can_simple import describe_error
from rig.slip_rig.decode import decode_board, decode_speeds
from support.commands import COMMAND
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.manifest import profile_file
from zebro_lab.runs.stage import list_runs
from zebro_lab.walk.folder import read_walk

KILLS = int(os.environ.get("ZEBRO_LAB_KILLS", "20"))
SOAK = float(os.environ.get("ZEBRO_LAB_SOAK", "60"))  # s

pytestmark = [pytest.mark.long, pytest.mark.timeout(5400)]


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
        assert len(run.table) > 0
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
    assert "is incomplete" in fitted.stdout
    assert (tmp_path / "calibration" / "slip.toml").is_file()


def test_a_recorded_sweep_gives_the_law_that_the_simulated_rig_obeys(tmp_path):
    recorded = subprocess.run(
        [COMMAND, "record", "--rig", "rig-odrive-netft@sim", "--duration", "66", "--label", "sweep",
         "--data", str(tmp_path / "data"), "--seed", "0"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert recorded.returncode == 0, recorded.stderr
    out = tmp_path / "calibration"
    fitted = subprocess.run(
        [COMMAND, "calibrate", str(tmp_path / "data"), "--out", str(out)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert fitted.returncode == 0, fitted.stderr
    assert "verdict: not trustworthy" not in fitted.stdout
    found = pd.read_csv(out / "summary.csv").set_index("parameter")
    true = dict(zip((p.name for p in THESIS_LAW.parameters), THESIS_VALUES, strict=True))
    for name, value in true.items():
        row = found.loc[name]
        tell(
            f"{name}: {row['median']:.4g} ({row['q05']:.4g} to {row['q95']:.4g}), true {value:.4g}"
        )
        assert abs(row["median"] - value) < 4 * row["sd"]


SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]


def commanded(*arguments):
    subprocess.run([COMMAND, *map(str, arguments)], check=True, capture_output=True)


def test_the_recorded_imu_turns_as_the_recorded_legs_are_predicted_to(tmp_path):
    walk = ("walk", "--model", "no-slip", "--steering", 1.2, "--duration", 13, "--out")
    commanded(*walk, tmp_path / "turn")
    play = ("--play", tmp_path / "turn", "--duration", 14, "--label", "turn")
    commanded("record", "--zebro", "sim", "--imu", "sim", *play, "--data", tmp_path / "data")
    (run,) = (tmp_path / "data").iterdir()
    profile = load_imu_profile(str(profile_file(run, "imu")))
    stream = read_raw_log(run / "log.mcap").streams["/imu/raw"]
    t, yaw = sample_times(stream), decode_orientation(profile, stream).yaw
    turned = {}
    for model in (("--model", "no-slip"), ("--slip", "coulomb:0.38")):
        commanded("predict", run, *model, "--out", tmp_path / model[1])
        path = read_walk(tmp_path / model[1])
        seen = np.interp(path.t, t, yaw)
        turned[model[1]] = np.degrees([seen[-1] - seen[0], path.yaw[-1] - path.yaw[0]])
        tell(f"{model[1]}: IMU and prediction turn {turned[model[1]].round(1)} deg")
    seen, without_slip = turned["no-slip"]
    slip = abs(without_slip - turned["coulomb:0.38"][1])
    assert without_slip > 25
    assert abs(seen - without_slip) < max(slip, 1.0)


@contextlib.contextmanager
def driver_ended_by(number, *, device, profile):
    """Let another process turn a simulated disc, end it by a signal; yield the twin's address."""
    twin = subprocess.Popen([COMMAND, "sim", "rig", profile], stdout=subprocess.PIPE, text=True)
    try:
        lines = iter(twin.stdout.readline, "")
        address = next(line.split()[-1] for line in lines if line.startswith("to record the"))
        driver = subprocess.Popen(
            [sys.executable, "-c", DRIVE, address, device], stdout=subprocess.PIPE, text=True
        )
        assert driver.stdout.readline() == "turning\n"
        time.sleep(0.3)
        driver.send_signal(number)
        driver.communicate()
        time.sleep(0.8)
        yield address
    finally:
        twin.kill()
        twin.communicate()


@pytest.mark.parametrize("number", SIGNALS)
def test_a_board_whose_driver_is_gone_leaves_no_disc_turning(number):
    with driver_ended_by(number, device="board", profile="rig-board-serial") as address:
        board = open_rig(address).board
        with board:
            samples = []
            while len(samples) < 50:
                samples += board.read(0.5)
    _, speeds = decode_board(board.profile, samples)
    assert abs(speeds.leg[-1]) < 0.1


@pytest.mark.parametrize("number", SIGNALS)
def test_drives_on_can_whose_driver_is_gone_stop_by_their_own_watchdog(number):
    with driver_ended_by(number, device="drives", profile="rig-odrive-netft") as address:
        drives = open_rig(address).drives
        with drives:
            samples = []
            while len(samples) < 50:
                samples += drives.read(0.5)
    speeds = decode_speeds(drives.profile.leg, drives.profile.ground, samples)
    assert abs(speeds.leg[-1]) < 0.1
    expected = "" if number == signal.SIGINT else "watchdog timer expired"  # Ctrl-C disarms first
    of_leg = [s.status for s in samples if s.channel == drives.profile.leg.node]
    assert describe_error(of_leg[-1], drives.profile.firmware) == expected


DRIVE = """
import signal
import sys
signal.signal(signal.SIGINT, lambda *_: sys.exit())
from benchmarks.speed.recording import measure, report
from rig.backends import open_rig
from rig.clock_watch import sample_times
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.device import iterate
device = getattr(open_rig(sys.argv[1]), sys.argv[2])
with device:
    device.leg.arm(1.0)
    device.leg.set_speed(12.0)
    for _ in iterate(device, duration=0.5):
        pass
    print("turning", flush=True)
    for _ in iterate(device, duration=60.0):
        pass
"""


def test_nothing_is_lost_in_the_host_at_full_rate_for_long(tmp_path):
    manifest, share, size = measure(SOAK, tmp_path)
    tell(f"\n{SOAK:g} s:")
    report(manifest, share, size)
    for name, counters in manifest.counters.items():
        assert counters["received"] == manifest.streams[f"/{name}/raw"]
        assert {k: v for k, v in counters.items() if k != "received" and v} == {}
