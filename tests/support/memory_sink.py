# SPDX-License-Identifier: MIT
"""In-memory sink for an experiment's runs; satisfies `rig.experiment.sink.RunSink`."""

from dataclasses import dataclass, field

from rig.experiment.readings import Batch, Readings, join
from rig.experiment.sink import RunStart, SinkFailed
from rig.experiment.verdict import PointVerdict


@dataclass
class MemoryRun:
    """A run kept in memory.

    Attributes:
        start: What was known before.
        parts: Batches of readings, in order of arrival.
        verdict: What it is worth.
        reason: Why it ended; empty while it is open.
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
    """Sink that keeps runs and events in memory.

    Attributes:
        runs: Every run, aborted ones included.
        events: Kind and text of each event.
        latched: Reasons of emergency stops.
        room: Free space [bytes].
    """

    def __init__(self) -> None:
        self.runs: list[MemoryRun] = []
        self.latched: list[str] = []
        self.events: list[tuple[str, str]] = []
        self.room = float("inf")

    @property
    def accepted(self) -> list[MemoryRun]:
        """The runs with a good verdict."""
        return [run for run in self.runs if run.verdict is not None and run.verdict.accepted]

    def open_run(self, start: RunStart) -> None:
        """Open a run."""
        self.runs.append(MemoryRun(start))

    def write(self, readings: Readings, batch: Batch) -> None:
        """Append samples to the open run."""
        del batch
        self.require_room(1.0)
        self.runs[-1].parts.append(readings)

    def close_run(self, verdict: PointVerdict | None, *, reason: str) -> None:
        """Close the run."""
        self.runs[-1].verdict, self.runs[-1].reason = verdict, reason

    def event(self, kind: str, text: str) -> None:
        """Append an event."""
        self.events.append((kind, text))

    def require_room(self, least: float) -> None:
        """Raise SinkFailed if there is less free space than required [bytes]."""
        if self.room < least:
            raise SinkFailed(f"room left is {self.room:g} bytes; its limit is {least:g} bytes")

    def latch(self, reason: str) -> None:
        """Record an emergency stop that stays latched."""
        self.latched.append(reason)
