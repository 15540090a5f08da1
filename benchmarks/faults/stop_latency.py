# SPDX-License-Identifier: MIT
"""How soon the discs are told to stop, by what goes wrong; prints the table of experiments.md.

python -m benchmarks.faults.stop_latency [TRIALS] [ROW...]

Each trial is a `zebro-lab rig run` on a terminal of its own, with a twin in another process whose
discs turn at 12 rad/s while a point is recorded. Latency counts from the fault's first byte, for
guards from when the first sample beyond the limit was due, to when the twin has the whole stop
command: the first set-point of the ramp, or the command to de-energise both drives; after SIGKILL
and SIGSTOP, to when the watchdog stops them. Apart from it
the time to rest. The last line on the terminal, exit code and last line of the journal must agree.
Trials that the machine ended before their fault came are made again. These, trials that ended for
another reason, and whatever is wrong, are told on standard error.

Rows are named by any part of their name; without one, all are measured. Needs Linux; the row of a
disk that is really full needs the right to mount one of its own.
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.faults.stop_faults import ROWS, Row, is_named
from benchmarks.faults.stop_latency_lab import DEADLY_KEY, Lab, latch_holds
from benchmarks.faults.stop_latency_twin import TOP_SPEED, Seen, Twin, rest_after, twin_process

PROJECT: Final = Path(__file__).parents[2]
LOAD: Final = 5.0
SETTLED: Final = (0.8, 1.2)
"""When the fault comes after a point's recording began: a random time between these [s]."""
BETWEEN_KEYS: Final = 0.05
"""A quick typist's; the last key is the one whose latency counts [s]."""
HELD: Final = 1.5
"""How long a program is held that SIGSTOP holds: until its discs stand [s]."""
SLOWEST_START: Final = 60.0
LONGEST_END: Final = 30.0
DISK: Final = 80 << 20
"""Size of the disk that is filled: above what a run must find free [bytes]."""
LIMIT: Final = 0.5
"""Longest latency allowed [s]."""


@dataclass(frozen=True)
class Trial:
    """One trial.

    Attributes:
        latency: From the fault to the stop command; NaN where none came [s].
        rest: From the fault until both discs stood; NaN where they never did [s].
        problems: What does not agree, one phrase each.
        other: Why it ended, where another stop came before that of the fault, or on the way.
    """

    latency: float
    rest: float
    problems: tuple[str, ...]
    other: str


class StoppedBefore(Exception):
    """The rig stopped before the fault came: the machine held the program or the twin up."""


@contextmanager
def folder_for(row: Row) -> Iterator[Path]:
    """Make a folder for an experiment, on a small disk of its own where that is to be filled.

    Raises:
        PermissionError: Such a disk cannot be mounted.
    """
    with tempfile.TemporaryDirectory(prefix="stop-latency-", ignore_cleanup_errors=True) as place:
        if row.way != "fill":
            yield Path(place)
            return
        mount = ["mount", "-t", "tmpfs", "-o", f"size={DISK}", "stop-latency", place]
        if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
            raise PermissionError("a disk can be mounted by root alone")
        try:
            yield Path(place)
        finally:
            subprocess.run(["umount", "--lazy", place], check=False)


def write_plan(file: Path, row: Row) -> None:
    """Write the thesis's plan with one long point."""
    text = (PROJECT / "examples" / "plan-thesis.toml").read_text(encoding="utf-8")
    changes = {
        "loads": f"[{LOAD}]", "slips": "[0.3]", "duration": "60.0", "tare_duration": "0.2",
        "length": '"duration"', "free_space": "1e6" if row.way == "fill" else "100e6",
    }  # fmt: skip
    lines = []
    for line in text.splitlines():
        key = line.partition("=")[0].strip()
        lines.append(f"{key} = {changes[key]}" if key in changes else line)
        if key == "[limits]" and row.rig == "drives":
            lines += ["lateral_force = 15.0", "torque = 1.0", "temperature_celsius = 80.0"]
    file.write_text("\n".join(lines), encoding="utf-8")


def write_profile(file: Path, twin: Twin) -> str:
    """Return the rig's address; a load cell's is in a profile of its own."""
    if "cell" not in twin.place:
        return f"rig-board-serial@{twin.place['port']}"
    text = (PROJECT / "rig" / "profiles" / "rig-odrive-netft.toml").read_text(encoding="utf-8")
    text = text.replace('"192.168.1.1"', '"127.0.0.1"').replace("49152", str(twin.place["cell"]))
    file.write_text(text, encoding="utf-8")
    return f"{file}@{twin.place['port']}"


def bring_to_speed(lab: Lab, twin: Twin, data: Path) -> None:
    """Confirm prompts as an operator does, until a point is being recorded.

    Raises:
        StoppedBefore: It never is.
    """
    asked_at = 0.0

    def recording() -> bool:
        nonlocal asked_at
        if time.monotonic() - asked_at > 0.2 and "then confirm" in lab.output:
            asked_at = time.monotonic()
            if "set the normal force to" in lab.output:
                twin.load(LOAD)
            lab.type(b"\n")
        return any(data.glob("*/log.mcap"))

    if not lab.watch(recording, SLOWEST_START):
        raise StoppedBefore(lab.last_lines)


def cause(row: Row, lab: Lab, twin: Twin, data: Path) -> float:
    """Bring the fault about; return when its first byte came, or began to [s]."""
    at = time.monotonic()
    if row.way == "guard":
        twin.fail(row.what)
    elif row.way == "signal":
        lab.signal(signal.Signals[row.what])
    elif row.way == "inside":
        lab.signal(signal.SIGUSR1)
    elif row.way == "hang up":
        lab.hang_up()
    elif row.way == "remove":
        shutil.rmtree(data, ignore_errors=True)
    elif row.way == "fill":
        with contextlib.suppress(OSError), (data / "filler").open("wb", buffering=0) as file:
            while True:
                at = time.monotonic()  # the last byte that finds room is in what follows
                file.write(bytes(1 << 20))
    else:
        *before, last = row.what if "\x03" in row.what else [row.what]
        for key in before:
            lab.type(key.encode())
            lab.watch(lambda: False, BETWEEN_KEYS)
        at = time.monotonic()
        lab.type(last.encode())
    return at


def stop_time(row: Row, seen: Seen, since: float) -> float:
    """Return when the first stop command after the fault was received whole; NaN without one."""
    if row.what in ("SIGKILL", "SIGSTOP"):
        return seen.expired_at or np.nan
    for at, leg, both in seen.commands:
        if at > since and (both or (row.ramps and leg < TOP_SPEED - 1e-3)):
            return at
    return np.nan


def last_entry(data: Path) -> dict[str, object]:
    """Return the last line of the journal; empty where there is none."""
    try:
        return json.loads((data / "experiment.jsonl").read_text(encoding="utf-8").splitlines()[-1])
    except FileNotFoundError:
        return {}


def disagreements(row: Row, lab: Lab, data: Path) -> list[str]:
    """List where the last line on the terminal, the exit code and the journal do not agree."""
    end = last_entry(data)
    if row.what == "SIGKILL":
        found = [] if lab.code == row.code else [f"exit code {lab.code}, not {row.code}"]
        return found + (["journal has an end"] if end.get("kind") == "end" else [])
    if row.way == "remove":  # the journal is gone with it
        agree = lab.code == row.code and row.says in lab.last_lines
        return [] if agree else [f"exit code {lab.code}; terminal: {lab.last_lines}"]
    if end.get("kind") != "end":
        return [f"the journal's last line is: {end}; terminal: {lab.last_lines}"]
    reason = str(end["text"])
    # A stop is told by its own words, an error by those after its class.
    stopped = reason.startswith(("safe stop: ", "emergency stop: "))
    words = reason if stopped else reason.partition(": ")[2]
    found = [] if lab.code == (130 if stopped else 1) else [f"exit code {lab.code}: {reason}"]
    if row.way != "hang up" and " ".join(words.split()) not in lab.last_lines:
        found.append(f"terminal: {lab.last_lines}; journal: {reason}")
    return found


def other_reason(row: Row, data: Path) -> str:
    """Return the reason in the journal where it is not the one that the fault should give."""
    end = last_entry(data)
    known = row.what == "SIGKILL" or row.way == "remove" or row.says in str(end.get("text"))
    return "" if known else str(end.get("text"))


def try_once(row: Row, rng: np.random.Generator) -> Trial:
    """Make one trial of a row.

    Raises:
        StoppedBefore: Its fault never came to be.
    """
    with ExitStack() as stack:
        place = stack.enter_context(folder_for(row))
        twin = stack.enter_context(twin_process(row.rig))
        data, plan = place / "data", place / "plan.toml"
        write_plan(plan, row)
        address = write_profile(place / "rig.toml", twin)
        arguments = ["rig", "run", str(plan), "--rig", address, "--data", str(data)]
        planted = row.what if row.way == "inside" else ""
        keyboard = DEADLY_KEY.decode() in row.what
        lab = Lab(arguments, planted="keyboard" if keyboard else planted)
        stack.callback(lab.close)
        bring_to_speed(lab, twin, data)
        began = time.monotonic()
        if (
            lab.watch(lambda: "STOPPED" in lab.output, rng.uniform(*SETTLED))
            or lab.code is not None
        ):
            raise StoppedBefore(lab.last_lines)
        at = cause(row, lab, twin, data)
        if row.what == "\x03" and lab.watch(lambda: "HOLDING" in lab.output, LONGEST_END):
            lab.signal(signal.SIGTERM)
        if row.what == "SIGSTOP":
            time.sleep(HELD)
            lab.signal(signal.SIGCONT)
        problems = [] if lab.wait(LONGEST_END) is not None else ["it did not end"]
        time.sleep(1.0 if row.code < 0 else 0.3)  # until the discs truly stand
        seen = twin.seen()
        if row.way == "guard":
            at = seen.fault_at or np.nan
        if any(both for when, _, both in seen.commands if began < when < at):
            raise StoppedBefore(lab.last_lines)
        problems += disagreements(row, lab, data)
        if row.says == "emergency stop" and not latch_holds(arguments):
            problems.append("the emergency stop is not latched")
        stood = rest_after(seen, at)
        if stood is None:
            problems.append("the discs still turn")
        latency, rest = stop_time(row, seen, at) - at, (stood or np.nan) - at
        return Trial(latency, rest, tuple(problems), other_reason(row, data))


def measure(row: Row, trials: int, rng: np.random.Generator) -> list[str]:
    """Measure a row and print it; return what was wrong."""
    done: list[Trial] = []
    before: list[str] = []
    while len(done) < trials and len(before) <= trials:
        try:
            done.append(try_once(row, rng))
        except PermissionError as error:
            print(f"| {row.name} | not measured: {error} | | | | | |", flush=True)
            return []
        except StoppedBefore as error:
            before.append(f"{row.name}: stopped before the fault, tried again: {error}")
    for line in before:
        print(line, file=sys.stderr, flush=True)
    if not done:
        return [f"{row.name}: not one trial came as far as its fault"]
    latency = 1e3 * np.array([trial.latency for trial in done])
    rest = 1e3 * np.array([trial.rest for trial in done])
    agree = sum(not trial.problems for trial in done)
    print(
        f"| {row.name} | {len(done)} | {np.median(latency):.0f} | {latency.max():.0f} "
        f"| {np.median(rest):.0f} | {rest.max():.0f} | {agree} of {len(done)} |",
        flush=True,
    )
    for trial in done:
        if trial.other:
            print(f"{row.name}: ended for another reason: {trial.other}", file=sys.stderr)
    wrong = [f"{row.name}: {problem}" for trial in done for problem in trial.problems]
    late = [f"{row.name}: {1e3 * trial.latency:.0f} ms, ended by: {trial.other or row.says}"
            for trial in done if not trial.latency <= LIMIT]  # fmt: skip
    for line in wrong + late:
        print(f"WRONG: {line}", file=sys.stderr, flush=True)
    return wrong + late


def main() -> None:
    """Measure the rows that are named, or all."""
    words = sys.argv[1:]
    trials = int(words.pop(0)) if words and words[0].isdigit() else 20
    rows = [row for row in ROWS if not words or any(is_named(row, word) for word in words)]
    if not rows:
        sys.exit(f"no row is named {' or '.join(words)}; see benchmarks.faults.stop_latency")
    rng = np.random.default_rng(1)
    print("| fault | trials | stop command: median [ms] | worst | rest: median [ms] | worst "
          "| line, code and journal agree |")  # fmt: skip
    print("|---|---:|---:|---:|---:|---:|---:|", flush=True)
    wrong = [problem for row in rows for problem in measure(row, trials, rng)]
    with contextlib.suppress(OSError):
        print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
