# SPDX-License-Identifier: MIT
"""Shows how a recording is doing from a thread of its own: a frozen viewer holds up nothing."""

import threading
import time
from collections.abc import Callable
from typing import Final, Generic, TypeVar

from zebro_lab.files.errors import RecordingError
from zebro_lab.recording.threads import needing_threads

PATIENCE: Final = 1.0
"""A display that has not returned after this is given up [s]."""

Status = TypeVar("Status")


class Display(Generic[Status]):
    """Hands the newest status to a display, until that raises or hangs.

    Args:
        show: The display; called in a thread of its own, one call at a time.
        give_up: Told once, in whichever thread, why nothing is shown any more.
    """

    def __init__(
        self, show: Callable[[Status], object], *, give_up: Callable[[str], object]
    ) -> None:
        self._show = show
        self._give_up = give_up
        self._newest: Status | None = None
        self._since: float | None = None
        self._over = False
        self._ending = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, daemon=True, name="display")
        try:
            with needing_threads():
                self._thread.start()
        except RecordingError as error:
            self._end(f"display cannot be started, recording goes on without it: {error}")

    def show(self, status: Status) -> None:
        """Take a status in place of one that has not been shown yet; never waits."""
        with self._changed:
            self._newest = status
            self._changed.notify()
            since = self._since
        if since is not None and time.monotonic() - since > PATIENCE:
            self._hangs()

    def close(self) -> None:
        """Show what was taken last, and end; waits for a display that hangs no longer than it may.

        A display that hangs is left to itself.
        """
        with self._changed:
            self._ending = True
            self._changed.notify()
        if self._thread.is_alive() and not self._over:
            self._thread.join(PATIENCE)
            if self._thread.is_alive():
                self._hangs()

    def _hangs(self) -> None:
        self._end(f"display has not returned for {PATIENCE:g} s, recording goes on without it")

    def _end(self, why: str) -> None:
        with self._changed:
            first, self._over = not self._over, True
            self._changed.notify()
        if first:
            self._give_up(why)

    def _run(self) -> None:
        while (status := self._take()) is not None:
            try:
                self._show(status)
            except BaseException as error:  # noqa: BLE001, RUF100 - whatever a terminal or a plot may raise
                self._end(f"display failed, recording goes on without it: {error!r}")

    def _take(self) -> Status | None:
        """Wait for a status to show; None where the end has come."""
        with self._changed:
            self._since = None
            self._changed.wait_for(lambda: self._newest is not None or self._ending or self._over)
            status, self._newest = self._newest, None
            if self._over:
                return None
            self._since = time.monotonic()
            return status
