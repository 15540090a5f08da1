# SPDX-License-Identifier: MIT
"""Who follows a run of a plan: a terminal, or nobody; never keeps the acquiring thread waiting."""

from typing import Protocol

from rig.experiment.condition import Condition
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict


class ExperimentWatcher(Protocol):
    """Who follows a run: a terminal, or nobody."""

    def changed(self, condition: Condition) -> None:
        """Hear that the state of the run, or whether the discs are energised, has changed."""
        ...

    def notice(self, text: str) -> None:
        """Hear something that a person should know."""
        ...

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Hear what begins.

        Args:
            what: Name of the step.
            done: Points finished.
            of: Points in all.
            left: Time that the rest is reckoned to take [s].
        """
        ...

    def prompt(self, text: str, *, normal: float) -> None:
        """Hear, again and again, what a person is asked to do and the normal force now [N]."""
        ...

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Hear what a point is worth."""
        ...


class NobodyWatches:
    """A watcher that does nothing."""

    def changed(self, condition: Condition) -> None:
        """Ignore it."""

    def notice(self, text: str) -> None:
        """Ignore it."""

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Ignore it."""

    def prompt(self, text: str, *, normal: float) -> None:
        """Ignore it."""

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Ignore it."""
