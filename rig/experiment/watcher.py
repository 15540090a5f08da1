# SPDX-License-Identifier: MIT
"""Base of the progress display of an experiment, which must not block the acquiring thread."""

from rig.experiment.condition import Condition
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict


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
