# SPDX-License-Identifier: MIT
"""Keep an experiment's runs in memory; satisfies `rig.experiment.sink.RunSink`."""

from dataclasses import dataclass, field

from rig.experiment.readings import Batch, Readings, join
from rig.experiment.sink import RunStart, SinkFailed
from rig.experiment.verdict import PointVerdict


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
    """Keeps runs and events in memory.

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
