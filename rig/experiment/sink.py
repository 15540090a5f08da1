# SPDX-License-Identifier: MIT
"""Where an experiment's samples and events go: the interface of its recorder."""

from dataclasses import dataclass
from typing import Protocol

from rig.errors import RigError
from rig.experiment.readings import Batch, Readings
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
