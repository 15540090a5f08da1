# SPDX-License-Identifier: MIT
"""Interface of the progress display of an experiment; it must not block the acquiring thread."""

from typing import Protocol

from rig.experiment.condition import Condition
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict


class ExperimentWatcher(Protocol):
    """Receiver of progress, prompts and verdicts of a run, such as a terminal."""

    def changed(self, condition: Condition) -> None:
        """Show a change of the run's state, or of whether the discs are energised."""
        ...

    def notice(self, text: str) -> None:
        """Show a message to a person."""
        ...

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Show the step that begins.

        Args:
            what: Name of the step.
            done: Number of finished points.
            of: Number of all points.
            left: Estimated remaining time [s].
        """
        ...

    def prompt(self, text: str, *, normal: float) -> None:
        """Show a prompt for the operator; called repeatedly until it is followed.

        Args:
            text: What the operator must do.
            normal: Present normal force [N].
        """
        ...

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Show the verdict on a point.

        Args:
            point: The point.
            verdict: Result of its quality checks.
            attempt: Number of the attempt, from 1.
        """
        ...


class NobodyWatches:
    """A watcher that does nothing."""

    def changed(self, condition: Condition) -> None:
        """Ignore a change of state."""

    def notice(self, text: str) -> None:
        """Ignore a message."""

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Ignore a step; see `ExperimentWatcher.doing`.

        Args:
            what: Name of the step.
            done: Number of finished points.
            of: Number of all points.
            left: Estimated remaining time [s].
        """

    def prompt(self, text: str, *, normal: float) -> None:
        """Ignore a prompt; see `ExperimentWatcher.prompt`.

        Args:
            text: What the operator must do.
            normal: Present normal force [N].
        """

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Ignore a verdict; see `ExperimentWatcher.judged`.

        Args:
            point: The point.
            verdict: Result of its quality checks.
            attempt: Number of the attempt, from 1.
        """
