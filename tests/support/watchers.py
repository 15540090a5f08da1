# SPDX-License-Identifier: MIT
"""Watchers for tests: of computations (`step`, `stop_requested`) and of recordings (`show`)."""


class Nobody:
    """Never asks to stop.

    Attributes:
        seen: What was reported: the steps and how far each was.
    """

    def __init__(self) -> None:
        self.seen: list[tuple[str, float | None]] = []

    def step(self, what: str, fraction: float | None) -> None:
        self.seen.append((what, fraction))

    def stop_requested(self) -> bool:
        return False


class Impatient(Nobody):
    """Asks to stop from the first moment."""

    def stop_requested(self) -> bool:
        return True


class Onlooker:
    """Looks on while devices are recorded; never ends the recording."""

    def show(self, status: object) -> None:
        pass

    def stop_reason(self) -> str | None:
        return None


class RecordWatcher:
    """Looks on; asks for the end after so many looks or samples of each stream, or raises."""

    def __init__(self, *, looks=None, samples=None, error=None):
        self.seen = []
        self._looks, self._samples, self._error = looks, samples or {}, error

    def show(self, status):
        self.seen.append(status)
        if self._error is not None and len(self.seen) > 2:
            raise self._error

    def stop_reason(self):
        looked = self._looks is not None and len(self.seen) >= self._looks
        return "key" if looked or self._enough() else None

    def _enough(self):
        if not (self._samples and self.seen):
            return False
        streams = self.seen[-1].streams
        return all(streams[k].counters.received >= n for k, n in self._samples.items())
