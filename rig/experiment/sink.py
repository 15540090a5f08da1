# SPDX-License-Identifier: MIT
"""Interfaces of a run: recorder of its samples and events, and display of its progress."""

from dataclasses import dataclass
from typing import Protocol

from rig.errors import RigError
from rig.experiment.condition import Condition
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
        guards_off: Guards that are off, with their limits, as text; empty where none is.
    """

    point: Point
    attempt: int
    time: float
    zero: Zero
    guards_off: str = ""


class RunSink(Protocol):
    """Recorder of runs, one for each attempt at a point; must not block the acquiring thread.

    Every method but `latch` may raise `SinkFailed`, which stops the rig.
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
        """Store the latch of an emergency stop at once, also after an earlier failure.

        Must not raise: a failure is raised by the next call of another method.
        """
        ...


class ExperimentWatcher:
    """Receiver of progress, prompts and verdicts of a run; this one ignores them all."""

    def changed(self, condition: Condition) -> None:
        """Show a change of the run's state, or of whether the discs are energised."""

    def notice(self, text: str) -> None:
        """Show a message to a person."""

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Show which step begins, and the progress of the run.

        Args:
            what: Name of the step, with the attempt from the second on and guards that are off.
            done: Number of accepted points, those of an earlier run included.
            of: Number of points of the plan, check points included.
            left: Estimated time of the remaining steps [s].
        """

    def prompt(self, text: str, *, normal: float) -> None:
        """Show a prompt for the operator; called repeatedly until the load is set.

        Args:
            text: What the operator must do.
            normal: Present normal force less the zero, once one was measured [N].
        """

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Show the verdict on an attempt at a point.

        Args:
            point: The point.
            verdict: Result of its quality checks.
            attempt: Number of the attempt, from 1.
        """
