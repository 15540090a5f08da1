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
