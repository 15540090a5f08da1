# SPDX-License-Identifier: MIT
"""Read generated files by every reader of users' files; print the table of docs/reading.md.

python -m benchmarks.faults.readers_fuzz [--inputs N] [--only PART OF A NAME] [--leave-out NAME]

Each reader runs in a process of its own, so that its memory is its own and a crash or a hang inside
a library ends it alone. Files are written to memory (/dev/shm) where there is such a place.
"""

import argparse
import logging
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.faults.fuzzed_readers.archives import of_archives
from benchmarks.faults.fuzzed_readers.logs import of_logs
from benchmarks.faults.fuzzed_readers.manifests import of_manifests, of_reports
from benchmarks.faults.fuzzed_readers.pictures import of_pictures
from benchmarks.faults.fuzzed_readers.reader import Reader
from benchmarks.faults.fuzzed_readers.settings import of_settings
from benchmarks.faults.fuzzed_readers.tables import every_column, of_tables
from benchmarks.faults.fuzzed_readers.trajectories import of_trajectories
from benchmarks.faults.fuzzed_readers.workbooks import of_workbooks
from model.errors import ModelError
from rig.errors import RigError
from tracking.errors import TrackingError
from zebro_lab.files.errors import ZebroLabError

DOCUMENTED = (ZebroLabError, RigError, TrackingError, ModelError)
LONGEST = 10.0
"""Time of the processor that no input may take [s]."""
MOST_MEMORY = 1e9
CHECKED = 10  # every so many inputs are counted whether they pass the first check


@dataclass
class Outcome:
    """What a reader did with its inputs; times in s, memory in bytes."""

    inputs: int = 0
    read: int = 0
    refused: int = 0
    checked: int = 0
    passed: int = 0
    slowest: float = 0.0
    seconds: float = 0.0
    memory: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    samples: dict[str, bytes] = field(default_factory=dict)

    @property
    def good(self) -> bool:
        """Tell whether every input ended in one line, soon and within memory."""
        return not self.faults and self.slowest < LONGEST and self.memory <= MOST_MEMORY


def trial(reader: Reader, count: int, seed: int, folder: Path, *, bombs: bool) -> Outcome:
    """Feed a reader with special inputs, then with `count` generated ones."""
    file = folder / reader.file
    file.parent.mkdir(parents=True, exist_ok=True)
    if reader.prepare is not None:
        reader.prepare(folder)
    outcome, rng = Outcome(), np.random.default_rng(seed)
    for data in reader.special() if bombs else ():
        _feed(reader, data, file, outcome)
    for number in range(count):
        data = reader.make(rng)
        if number % CHECKED == 0:
            outcome.checked += 1
            outcome.passed += _passes(reader, data)
        _feed(reader, data, file, outcome)
    outcome.memory = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return outcome


def _feed(reader: Reader, data: bytes, file: Path, outcome: Outcome) -> None:
    file.write_bytes(data)
    # End the process where a library never returns, in its own time and by the clock on the wall.
    signal.setitimer(signal.ITIMER_PROF, 2 * LONGEST)
    signal.alarm(300)
    begun = time.process_time()
    fault = None
    try:
        reader.read(file)
        outcome.read += 1
    except DOCUMENTED as error:
        outcome.refused += 1
        if len(str(error).splitlines()) > 1:
            fault = f"more than one line: {type(error).__name__}"
    except Exception as error:  # counted: that is what this is for
        last = traceback.extract_tb(error.__traceback__)[-1]
        fault = f"{type(error).__name__} at {Path(last.filename).name}:{last.lineno}"
        outcome.samples.setdefault(fault, data[:100_000])
    taken = time.process_time() - begun
    outcome.inputs += 1
    outcome.seconds += taken
    outcome.slowest = max(outcome.slowest, taken)
    if fault is not None:
        outcome.faults[fault] += 1


def _passes(reader: Reader, data: bytes) -> bool:
    try:
        reader.check(data)
    except Exception:  # whatever a parser answers with
        return False
    return True


def _in_process(reader: Reader, count: int, seed: int, bombs: bool, out: Any) -> None:
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    os.environ["OPENCV_LOG_LEVEL"] = "OFF"
    memory = Path("/dev/shm")  # noqa: S108 - a folder of our own is made in it
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        out.send(trial(reader, count, seed, Path(folder), bombs=bombs))


def run(reader: Reader, count: int, seed: int, *, bombs: bool = True) -> Outcome:
    """Try a reader in a process of its own; that it ended early is a fault."""
    context = get_context("fork")
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=_in_process, args=(reader, count, seed, bombs, send))
    process.start()
    send.close()
    try:
        outcome = receive.recv()
    except EOFError:
        outcome = Outcome()
    process.join()
    if process.exitcode:
        outcome.faults[f"process ended with {process.exitcode}"] += 1
    return outcome


def readers() -> dict[str, Reader]:
    """Return all readers by name, those first that take the least time."""
    return {
        **of_settings(), **of_manifests(), **of_archives(), **of_logs(), **of_tables(),
        **of_trajectories(), **of_workbooks(every_column), **of_reports(), **of_pictures(),
    }  # fmt: skip


def main(arguments: list[str]) -> int:
    """Print a line a reader; return 1 where one did not keep its bounds."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--inputs", type=int, default=None, help="for each reader; its own without")
    parser.add_argument("--only", default="", help="readers whose name holds this")
    parser.add_argument("--leave-out", default=None, metavar="NAME")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--without-bombs", action="store_true")
    parser.add_argument("--keep", type=Path, help="folder for an input of each fault")
    asked = parser.parse_args(arguments)
    print("| reader | inputs | past first check [%] | read | refused | tracebacks "
          "| slowest [s of CPU] | memory [MB] |\n|---|---|---|---|---|---|---|---|")  # fmt: skip
    bad, faults = 0, Counter[str]()
    for name, reader in readers().items():
        if asked.only not in name or name == asked.leave_out:
            continue
        outcome = run(reader, asked.inputs or reader.inputs, asked.seed,
                      bombs=not asked.without_bombs)  # fmt: skip
        share = 100 * outcome.passed / max(outcome.checked, 1)
        print(f"| {name} | {outcome.inputs} | {share:.0f} | {outcome.read} | {outcome.refused} | "
              f"{outcome.faults.total()} | {outcome.slowest:.2f} | {outcome.memory / 1e6:.0f} |",
              flush=True)  # fmt: skip
        bad += not outcome.good
        faults.update({f"{name}: {what}": times for what, times in outcome.faults.items()})
        for what, data in outcome.samples.items() if asked.keep else ():
            asked.keep.mkdir(parents=True, exist_ok=True)
            (asked.keep / f"{name} {what}".replace("/", "_")).write_bytes(data)
    for what, times in faults.most_common():
        print(f"{times} x {what}")
    return int(bad > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
