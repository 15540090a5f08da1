# SPDX-License-Identifier: MIT
"""Progress reports and stop requests between a long computation and whoever started it."""

from typing import Protocol


class Watcher(Protocol):
    """Follows a long computation: a progress bar, or nothing."""

    def step(self, what: str, fraction: float | None) -> None:
        """Take what is going on, and how far it is (None: unknown)."""
        ...

    def stop_requested(self) -> bool:
        """Tell whether the computation should stop at the next good moment."""
        ...
