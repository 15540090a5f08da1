# SPDX-License-Identifier: MIT
"""How a long computation reports progress and is asked to stop."""

from typing import Protocol


class Watcher(Protocol):
    """Follows a long computation: a progress bar, or nobody."""

    def step(self, what: str, fraction: float | None) -> None:
        """Take note of the current step and of the fraction of it that is done.

        Args:
            what: Name of the step.
            fraction: Share of the step that is done [-]; None where it is unknown.
        """
        ...

    def stop_requested(self) -> bool:
        """Return whether the computation should stop at the next good moment."""
        ...
