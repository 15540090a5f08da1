# SPDX-License-Identifier: MIT
"""Generated inputs for every reader of users' files, and for every parser of what devices send.

python -m benchmarks.faults.fuzz [--inputs N] [--only PART OF A NAME] [--seed N] [--keep FOLDER]

Each reads its inputs in a process of its own, so that its memory is its own and a crash or a hang
inside a library ends it alone. Files are written to memory (/dev/shm) where there is such a place.
Exit code 1 tells that one raised what is not documented, took too long, or too much memory.
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

from benchmarks.faults.device_parsers import Parser, parsers
from benchmarks.faults.file_readers import readers
from benchmarks.faults.hostile_inputs import generate
from benchmarks.tables import print_table

LONGEST = 10.0
"""Time of the processor that no input may take [s]."""
MOST_MEMORY = 1e9
WITHOUT_MEMORY = 20  # inputs for which a parser that refuses what it took before is kept


@dataclass
class Outcome:
    """What came of a parser's inputs; times in s, memory in bytes."""

    inputs: int = 0
    accepted: int = 0
    refused: int = 0
    slowest: float = 0.0
    memory: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    samples: dict[str, bytes] = field(default_factory=dict)

    @property
    def good(self) -> bool:
        """Whether every input was accepted or refused, soon and within memory."""
        return not self.faults and self.slowest < LONGEST and self.memory <= MOST_MEMORY


def feed(parser: Parser, count: int, rng: np.random.Generator) -> Outcome:
    """Feed a parser with generated inputs, its special ones first."""
    outcome, take = Outcome(), parser.make()
    for number, data in enumerate((*parser.special, *generate(parser.valid, count, rng))):
        # End the process where a library never returns, in its own time and by the wall's clock.
        signal.setitimer(signal.ITIMER_PROF, 2 * LONGEST)
        signal.alarm(300)
        if parser.has_memory and number % WITHOUT_MEMORY == 0:
            take = parser.make()
        begun, fault = time.process_time(), ""
        try:
            accepted = take(data)
            outcome.accepted += accepted
            outcome.refused += not accepted
        except parser.refusals as error:
            outcome.refused += 1
            take = parser.make()
            fault = "more than one line" if "\n" in str(error) else ""
        except Exception as error:  # counted: that is what this is for
            last = traceback.extract_tb(error.__traceback__)[-1]
            fault = f"{type(error).__name__} at {Path(last.filename).name}:{last.lineno}"
            take = parser.make()
        outcome.inputs += 1
        outcome.slowest = max(outcome.slowest, time.process_time() - begun)
        if fault:
            outcome.faults[fault] += 1
            outcome.samples.setdefault(fault, data[:100_000])
    outcome.memory = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return outcome


def _in_process(parser: Parser, count: int, seed: int, out: Any) -> None:
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    os.environ["OPENCV_LOG_LEVEL"] = "OFF"
    memory = Path("/dev/shm")  # noqa: S108 - a folder of our own is made in it
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        os.chdir(folder)  # where readers find the files of their inputs
        out.send(feed(parser, count, np.random.default_rng(seed)))


def run(parser: Parser, count: int, seed: int) -> Outcome:
    """Try a parser in a process of its own; that it ended early is a fault."""
    context = get_context("fork")
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=_in_process, args=(parser, count, seed, send))
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


def main(arguments: list[str]) -> int:
    """Print a row a parser; return 1 where one did not keep its bounds."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--inputs", type=int, default=10_000, help="for each")
    parser.add_argument("--only", default="", help="those whose name holds this")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for an input of each fault")
    asked = parser.parse_args(arguments)
    every = {name: each for name, each in (readers() | parsers()).items() if asked.only in name}
    outcomes = {name: run(each, asked.inputs, asked.seed) for name, each in every.items()}
    print_table(
        ("reader or parser", "inputs", "accepted", "refused", "tracebacks", "slowest [s of CPU]",
         "memory [MB]"),
        *(
            (name, str(one.inputs), str(one.accepted), str(one.refused), str(one.faults.total()),
             f"{one.slowest:.2f}", f"{one.memory / 1e6:.0f}")
            for name, one in outcomes.items()
        ),
    )  # fmt: skip
    for name, outcome in outcomes.items():
        for what, times in outcome.faults.most_common():
            print(f"{times} x {name}: {what}")
        for what, data in outcome.samples.items() if asked.keep else ():
            asked.keep.mkdir(parents=True, exist_ok=True)
            (asked.keep / f"{name} {what}".replace("/", "_")).write_bytes(data)
    return int(not all(outcome.good for outcome in outcomes.values()))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
