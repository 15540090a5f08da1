# SPDX-License-Identifier: MIT
"""Interface of the recorder that stores an experiment's samples and events."""

from dataclasses import dataclass
from typing import Protocol

from rig.errors import RigError
from rig.experiment.readings import Batch, Readings
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict
from rig.slip_rig.decode import Zero


class SinkFailed(RigError, OSError):
    """Measurements or events cannot be stored: disk full, folder gone, queue full."""


@dataclass(frozen=True)
class RunStart:
    """Description of a run before its first sample.

    Attributes:
        point: Point that is measured.
        attempt: Number of the attempt, from 1.
        time: Host time at which the run begins, with an arbitrary origin [s].
        zero: Zero of the load cell that is subtracted from the readings.
    """

    point: Point
    attempt: int
    time: float
    zero: Zero


class RunSink(Protocol):
    """Recorder of runs, one for each attempt at a point; must not block the acquiring thread.

    Every method may raise `SinkFailed`, which stops the rig.
    """

    def open_run(self, start: RunStart) -> None:
        """Begin the recording of one attempt at a point."""
        ...

    def write(self, readings: Readings, batch: Batch) -> None:
        """Store samples of the run.

        Args:
            readings: Samples on a common time base, zero subtracted.
            batch: Batch of the readings, for its raw samples.
        """
        ...

    def close_run(self, verdict: PointVerdict | None, *, reason: str) -> None:
        """End the recording that `open_run` began, and store the verdict.

        Args:
            verdict: Verdict on the point; None where the run was aborted.
            reason: `completed`, or why the run ended.
        """
        ...

    def event(self, kind: str, text: str) -> None:
        """Store an event of the experiment; no run need be open.

        Args:
            kind: Kind of event, such as `note`.
            text: Description of the event.
        """
        ...

    def require_room(self, least: float) -> None:
        """Raise `SinkFailed`, in this or a later call, where less than `least` [bytes] is free."""
        ...

    def latch(self, reason: str) -> None:
        """Store the latch of an emergency stop at once, also after an earlier failure."""
        ...
