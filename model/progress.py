# SPDX-License-Identifier: MIT
"""Protocol by which a long computation reports progress and is asked to stop."""

from typing import Protocol


class Watcher(Protocol):
    """Receives progress of a long computation, for example a progress bar, and can stop it."""

    def step(self, what: str, fraction: float | None) -> None:
        """Report the current step and the fraction of it that is done.

        Args:
            what: Name of the step.
            fraction: Share of the step that is done [-]; None where it is unknown.
        """
        ...

    def stop_requested(self) -> bool:
        """Return whether the computation should stop at its next checkpoint."""
        ...
