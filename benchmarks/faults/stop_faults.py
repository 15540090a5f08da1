# SPDX-License-Identifier: MIT
"""The faults that `stop_latency.py` brings about, a row of its table each."""

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from benchmarks.faults.stop_latency_lab import DEADLY_KEY

Way: TypeAlias = Literal["signal", "keys", "hang up", "guard", "inside", "fill", "remove"]


@dataclass(frozen=True)
class Row:
    """A fault.

    Attributes:
        name: As it is called in the table.
        way: How it is brought about.
        what: Number of a signal, keys, or name of a fault in the twin or of a part of the program.
        says: Must be in the reason of the end.
        code: Exit code that is expected.
        ramps: The first set-point of the ramp is the stop command.
        rig: `board` or `drives`.
    """

    name: str
    way: Way
    what: str
    says: str
    code: int = 1
    ramps: bool = False
    rig: str = "board"


def _guard(name: str, what: str, says: str, rig: str = "board") -> Row:
    return Row(f"guard: {name}", "guard", what, says, rig=rig)


ROWS: Final = (
    Row("Ctrl-C (soft stop; ended by SIGTERM)", "keys", "\x03", "safe stop: SIGTERM", 130, True),
    Row("Ctrl-C three times (emergency)", "keys", "\x03\x03\x03", "emergency stop", 130),
    Row("key e (emergency)", "keys", "e\n", "emergency stop", 130),
    Row("SIGTERM", "signal", "SIGTERM", "safe stop: SIGTERM", 130, True),
    Row("SIGHUP", "signal", "SIGHUP", "safe stop: SIGHUP", 130, True),
    Row("terminal closed", "hang up", "", "", 1, True),
    Row("SIGKILL (the board's watchdog stops)", "signal", "SIGKILL", "", -9),
    Row("SIGKILL, drives (theirs do)", "signal", "SIGKILL", "", -9, rig="drives"),
    Row("SIGSTOP (the board's watchdog stops)", "signal", "SIGSTOP", "watchdog"),
    Row("SIGSTOP, drives (theirs do)", "signal", "SIGSTOP", "watchdog", rig="drives"),
    _guard("normal force", "normal force", "normal force is"),
    _guard("traction force", "traction force", "traction force is"),
    _guard("silence of the board", "silence", "'board' sent nothing"),
    _guard("status of the board", "status", "reports status"),
    _guard("age of readings (a link that lags)", "old readings", "age of a reading"),
    _guard("forces frozen", "frozen forces", "forces of the load cell stayed the same"),
    _guard("speed of the leg disc frozen", "frozen leg speed", "leg disc stayed the same"),
    _guard("speed of the ground disc frozen", "frozen ground speed", "ground disc stayed the same"),
    _guard("numbering restarts each 0.1 s", "restarts", "restarted its numbering"),
    _guard("numbering at random", "random numbers", "restarted its numbering"),
    _guard("three records of four damaged", "damaged records", "repeated or refused"),
    _guard("disc departs from its set-point", "departure", "speed error of the leg disc"),
    _guard("load cell saturated", "saturation", "transducer saturated", "drives"),
    _guard("third axis of the load cell", "lateral force", "third axis is", "drives"),
    _guard("torque on the load cell", "torque", "torque on the load cell is", "drives"),
    _guard("temperature of a drive", "temperature", "temperature of a drive", "drives"),
    _guard("error of a drive", "drive error", "drive of the leg disc reports", "drives"),
    _guard("silence of the load cell", "silent load cell", "'load cell' sent nothing", "drives"),
    _guard("silence of a drive", "silent drive", "leg drive' sent nothing", "drives"),
    _guard("silence of temperatures", "silent temperature", "drive' sent nothing", "drives"),
    Row("writer dies: a job raises", "inside", "writer's job", "data cannot be kept", ramps=True),
    Row("writer dies: its thread ends", "inside", "writer's thread", "writer", ramps=True),
    Row("writer dies: the log's thread ends", "inside", "log's thread", "planted", ramps=True),
    Row("keyboard dies", "keys", DEADLY_KEY.decode() + "\n", "keyboard failed", ramps=True),
    Row("screen dies", "inside", "screen", "screen failed", ramps=True),
    Row("disk full (a disk of its own)", "fill", "", "data cannot be kept", ramps=True),
    Row("disk full (the log's file says so)", "inside", "no space", "No space left", ramps=True),
    Row("folder removed", "remove", "", "was removed", ramps=True),
)


def is_named(row: Row, word: str) -> bool:
    """Tell whether a word names a row: a part of its name that is no other row's whole name."""
    return word == row.name if word in {other.name for other in ROWS} else word in row.name
