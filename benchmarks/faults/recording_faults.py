# SPDX-License-Identifier: MIT
"""What `zebro-lab record` does where its folder goes, its disk is slow, or its viewer stops.

python -m benchmarks.faults.recording_faults [TRIALS [SECONDS [FSYNC]]]

Each recording is the real command in a process of its own, with simulated legs and IMU:

* the run folder is removed while it records: time until the line on stderr that says so, and until
  the process has ended;
* every fsync takes FSYNC seconds, 3 by default: time from the first to the last sample against the
  one asked;
* its terminal is stopped (Ctrl-S), or its pipe is full and nobody reads it: samples lost, and the
  time from the first to the last.
"""

import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import termios
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from zebro_lab.mcap.raw_log import read_raw_log

SLOW_FSYNC: Final = 3.0
COMMAND: Final = """
import os, sys, time
real, slow = os.fsync, float(sys.argv.pop(1))
os.fsync = lambda file: (time.sleep(slow), real(file))[1]
from zebro_lab.main import main
main()
"""


@dataclass(frozen=True)
class Recorded:
    """A recording that has ended.

    Attributes:
        code: Exit code of the process.
        lasted: From the first to the last sample of the legs [s].
        received: Samples of all streams.
        lost: Samples that the numbering of any stream shows to be missing, or that were dropped.
        clocks: Streams whose clock was compared.
        status: Exit status in the end record.
    """

    code: int
    lasted: float
    received: int
    lost: int
    clocks: int
    status: str


@contextlib.contextmanager
def recording(
    data: Path,
    *options: str,
    fsync: float = 0.0,
    stdin: int | None = None,
    stdout: int = subprocess.DEVNULL,
    stderr: int = subprocess.DEVNULL,
) -> Iterator[subprocess.Popen[bytes]]:
    """Record simulated legs and IMU in a process of its own, which the end of the body kills."""
    command = [sys.executable, "-c", COMMAND, str(fsync), "record", "--zebro", "sim",
               "--imu", "sim", "--label", "x", "--data", str(data), *options]  # fmt: skip
    process = subprocess.Popen(command, stdin=stdin, stdout=stdout, stderr=stderr)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def growing(data: Path) -> Path:
    """Wait for a run that holds samples of the legs, and return its folder."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        for log in data.glob("*/log.mcap"):
            if "/legs/raw" in read_raw_log(log).streams:
                return log.parent
        time.sleep(0.02)
    raise TimeoutError("nothing was recorded within 60 s")


def result(folder: Path, code: int) -> Recorded:
    """Read what a recording left."""
    record = json.loads((folder / "run.json").read_text())
    counters = record["counters"].values()
    times = read_raw_log(folder / "log.mcap").streams["/legs/raw"].host_time
    return Recorded(
        code=code,
        lasted=float(times[-1] - times[0]),
        received=sum(each["received"] for each in counters),
        lost=sum(each["lost"] + each["dropped"] for each in counters),
        clocks=len(record.get("clocks", {})),
        status=record["exit_status"],
    )


def removed(place: Path, rng: np.random.Generator) -> tuple[float, float]:
    """Remove the run folder while it grows; return the times to the line and to the end [s]."""
    with recording(place, stderr=subprocess.PIPE) as process:
        folder = growing(place)
        time.sleep(rng.uniform(0.0, 1.0))
        shutil.rmtree(folder)
        began = time.monotonic()
        if process.stderr is None:
            raise RuntimeError("the recording has no stderr")
        line = process.stderr.readline()
        noticed = time.monotonic() - began
        more = process.stderr.read()
        code = process.wait(60)
        ended = time.monotonic() - began
    if code != 1 or more or b"removed or renamed" not in line:
        raise RuntimeError(f"exit code {code}, said {line!r} and {more!r}")
    return noticed, ended


def slow_disk(place: Path, seconds: float, fsync: float) -> Recorded:
    """Record for a while on a disk that takes some time to synchronise a file [s]."""
    with recording(place, "--duration", str(seconds), fsync=fsync) as process:
        code = process.wait(seconds + 120)
    return result(next(place.iterdir()), code)


def stopped_terminal(place: Path, seconds: float) -> Recorded:
    """Record for a while on a terminal that is stopped as by Ctrl-S, once samples have come."""
    master, slave = os.openpty()
    try:
        termios.tcsetwinsize(slave, (24, 100))
        with recording(
            place, "--duration", str(seconds), stdin=slave, stdout=slave, stderr=slave
        ) as process:
            folder = growing(place)
            termios.tcflow(slave, termios.TCOOFF)
            code = process.wait(seconds + 60)
    finally:
        os.close(slave)
        os.close(master)
    return result(folder, code)


def full_pipe(place: Path, seconds: float) -> Recorded:
    """Record for a while into a pipe that is full and that nobody reads."""
    reading, writing = os.pipe()
    try:
        os.set_blocking(writing, False)
        with contextlib.suppress(BlockingIOError):
            while os.write(writing, bytes(4096)):
                pass
        os.set_blocking(writing, True)
        with recording(
            place, "--duration", str(seconds), stdout=writing, stderr=writing
        ) as process:
            code = process.wait(seconds + 60)
    finally:
        os.close(writing)
        os.close(reading)
    return result(next(place.iterdir()), code)


def row(what: str, asked: float, runs: Sequence[Recorded]) -> str:
    """Make a row of the table of durations."""
    if any(run.code != 0 or run.status != "completed" or run.clocks != 2 for run in runs):
        raise RuntimeError(f"{what}: not completed with both clocks: {runs}")
    off = [100 * (run.lasted / asked - 1) for run in runs]
    return (
        f"| {what} | {asked:g} | {len(runs)} | {np.median(off):+.2f} % | "
        f"{max(off, key=abs):+.2f} % | {sum(run.received for run in runs)} | "
        f"{sum(run.lost for run in runs)} |"
    )


def main(trials: int, seconds: float, fsync: float = SLOW_FSYNC, *, seed: int = 1) -> None:
    """Print both tables."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as ground:
        places = (Path(ground) / f"{number}" for number in range(10**6))
        times = np.array([removed(next(places), rng) for _ in range(trials)])
        print("| run folder removed | trials | median [s] | worst [s] |\n|---|---|---|---|")
        for what, column in zip(("line on stderr", "process ended"), times.T, strict=True):
            print(f"| {what} | {trials} | {np.median(column):.2f} | {column.max():.2f} |")
        few = max(trials // 4, 1)
        print("\n| what | asked [s] | trials | off, median | off, worst | samples | lost |")
        print("|---|---|---|---|---|---|---|", flush=True)
        for asked in (seconds, 2 * seconds):
            runs = [slow_disk(next(places), asked, fsync) for _ in range(few)]
            print(row(f"fsync takes {fsync:g} s", asked, runs), flush=True)
        runs = [stopped_terminal(next(places), seconds) for _ in range(few)]
        print(row("terminal stopped", seconds, runs), flush=True)
        runs = [full_pipe(next(places), seconds) for _ in range(few)]
        print(row("pipe full, nobody reads", seconds, runs), flush=True)


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 20,
        float(sys.argv[2]) if len(sys.argv) > 2 else 5.0,
        float(sys.argv[3]) if len(sys.argv) > 3 else SLOW_FSYNC,
    )
