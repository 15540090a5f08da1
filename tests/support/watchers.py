# SPDX-License-Identifier: MIT
"""Progress reporters for tests of computations, and watchers for tests of recordings."""


class Nobody:
    """Progress that records the steps and never requests a stop.

    Attributes:
        seen: Reported steps with the fraction done.
    """

    def __init__(self) -> None:
        self.seen: list[tuple[str, float | None]] = []

    def step(self, what: str, fraction: float | None) -> None:
        self.seen.append((what, fraction))

    def stop_requested(self) -> bool:
        return False


class Impatient(Nobody):
    """Progress that requests a stop from the start."""

    def stop_requested(self) -> bool:
        return True


class Onlooker:
    """Watcher of a recording that displays nothing and never stops it."""

    def note(self, line: str) -> None:
        pass

    def show(self, status: object) -> None:
        pass

    def stop_reason(self) -> str | None:
        return None


class RecordWatcher:
    """Watcher that stops a recording after a number of calls or samples.

    Attributes:
        seen: Statuses that were shown.
        notes: Notes that were shown, each with the number of statuses shown before.
    """

    def __init__(self, *, looks=None, samples=None):
        self.seen = []
        self.notes = []
        self._looks, self._samples = looks, samples or {}

    def note(self, line):
        self.notes.append((line, len(self.seen)))

    def show(self, status):
        self.seen.append(status)

    def stop_reason(self):
        looked = self._looks is not None and len(self.seen) >= self._looks
        return "key" if looked or self._enough() else None

    def _enough(self):
        if not (self._samples and self.seen):
            return False
        streams = self.seen[-1].streams
        return all(streams[k].counters.received >= n for k, n in self._samples.items())
