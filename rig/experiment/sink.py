# SPDX-License-Identifier: MIT
"""Where an experiment's samples and events go, by protocol; and one that keeps them in memory."""

from dataclasses import dataclass, field
from typing import Protocol

from rig.errors import RigError
from rig.experiment.bench import Batch, Readings, join
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict
from rig.slip_rig.decode import Zero


class SinkFailed(RigError, OSError):
    """What was measured cannot be kept: disk full, folder gone, queue full."""


@dataclass(frozen=True)
class RunStart:
    """What is known of a run before its first sample.

    Attributes:
        point: What is measured.
        attempt: Which time it is tried, from 1.
        time: Host time, whose zero means nothing [s].
        zero: Zero of the load cell, subtracted from the readings.
    """

    point: Point
    attempt: int
    time: float
    zero: Zero


class RunSink(Protocol):
    """A recorder of runs, each a point; called by the acquiring thread, which it must not hold up.

    Every method may raise `SinkFailed`, upon which the rig is stopped.
    """

    def open_run(self, start: RunStart) -> None:
        """Begin a run."""
        ...

    def write(self, readings: Readings, batch: Batch) -> None:
        """Keep samples of the run.

        Args:
            readings: Lined up, zero subtracted.
            batch: The look at the rig they came with, for its raw samples.
        """
        ...

    def close_run(self, verdict: PointVerdict | None, *, reason: str) -> None:
        """End the run.

        Args:
            verdict: What it is worth; None where it was broken off.
            reason: `completed`, or why it ended.
        """
        ...

    def event(self, kind: str, text: str) -> None:
        """Keep something that happened, at once."""
        ...

    def require_room(self, least: float) -> None:
        """Raise SinkFailed where less than `least` can still be written [bytes]."""
        ...

    def latch(self, reason: str) -> None:
        """Keep, at once and whatever else has failed, that an emergency stop holds."""
        ...


@dataclass
class MemoryRun:
    """A run in memory.

    Attributes:
        start: What was known before.
        parts: Readings as they came.
        verdict: What it is worth.
        reason: Why it ended; empty while it goes on.
    """

    start: RunStart
    parts: list[Readings] = field(default_factory=list)
    verdict: PointVerdict | None = None
    reason: str = ""

    @property
    def readings(self) -> Readings:
        """All readings."""
        return join(self.parts)


class MemorySink:
    """A sink for tests and for looking at a rig without keeping anything.

    Attributes:
        runs: Every run, also those broken off.
        events: Kind and text of what happened.
        latched: Reasons of emergency stops.
        room: Room left [bytes].
    """

    def __init__(self) -> None:
        self.runs: list[MemoryRun] = []
        self.latched: list[str] = []
        self.events: list[tuple[str, str]] = []
        self.room = float("inf")

    @property
    def accepted(self) -> list[MemoryRun]:
        """The runs that are good."""
        return [run for run in self.runs if run.verdict is not None and run.verdict.accepted]

    def open_run(self, start: RunStart) -> None:
        """Begin a run."""
        self.runs.append(MemoryRun(start))

    def write(self, readings: Readings, batch: Batch) -> None:
        """Keep samples."""
        del batch
        self.require_room(1.0)
        self.runs[-1].parts.append(readings)

    def close_run(self, verdict: PointVerdict | None, *, reason: str) -> None:
        """End the run."""
        self.runs[-1].verdict, self.runs[-1].reason = verdict, reason

    def event(self, kind: str, text: str) -> None:
        """Keep something that happened."""
        self.events.append((kind, text))

    def require_room(self, least: float) -> None:
        """Raise SinkFailed where too little room is left [bytes]."""
        if self.room < least:
            raise SinkFailed(f"room left is {self.room:g} bytes; its limit is {least:g} bytes")

    def latch(self, reason: str) -> None:
        """Keep that an emergency stop holds."""
        self.latched.append(reason)
