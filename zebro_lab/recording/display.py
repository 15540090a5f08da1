# SPDX-License-Identifier: MIT
"""Non-blocking status display of a recording, in its own thread."""

import threading
import time
from collections.abc import Callable
from typing import Final

from zebro_lab.files.errors import RecordingError
from zebro_lab.recording.run_files import needing_threads
from zebro_lab.recording.status import RecordStatus

PATIENCE: Final = 1.0
"""Timeout of one call of the display, after which the display is abandoned [s]."""


class Display:
    """Thread that passes the newest status to a display, until the display raises or hangs.

    Args:
        show: Draws a status; called in the display's thread, one call at a time.
        give_up: Called at most once, in any thread, with the reason why the display failed.
    """

    def __init__(
        self, show: Callable[[RecordStatus], object], *, give_up: Callable[[str], object]
    ) -> None:
        self._show = show
        self._give_up = give_up
        self._newest: RecordStatus | None = None
        self._since: float | None = None
        self._over = False
        self._ending = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, daemon=True, name="display")
        try:
            with needing_threads():
                self._thread.start()
        except RecordingError as error:
            self._end(f"the display cannot start, the recording continues without it: {error}")

    def show(self, status: RecordStatus) -> None:
        """Set the status to show next, replacing one not shown yet; does not block.

        A display whose present call has taken longer than `PATIENCE` is abandoned.
        """
        with self._changed:
            self._newest = status
            self._changed.notify()
            since = self._since
        if since is not None and time.monotonic() - since > PATIENCE:
            self._hangs()

    def close(self) -> None:
        """Show the last status and end the thread.

        A display that takes longer than `PATIENCE` is abandoned.
        """
        with self._changed:
            self._ending = True
            self._changed.notify()
        if self._thread.is_alive() and not self._over:
            self._thread.join(PATIENCE)
            if self._thread.is_alive():
                self._hangs()

    def _hangs(self) -> None:
        self._end(f"the display hung for {PATIENCE:g} s, the recording continues without it")

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
                self._end(f"the display failed, the recording continues without it: {error!r}")

    def _take(self) -> RecordStatus | None:
        """Wait for a status and return it; None after a failure of the display.

        After `close` a status that is not shown yet is returned first, then None.
        """
        with self._changed:
            self._since = None
            self._changed.wait_for(lambda: self._newest is not None or self._ending or self._over)
            status, self._newest = self._newest, None
            if self._over:
                return None
            self._since = time.monotonic()
            return status
