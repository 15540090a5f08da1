# SPDX-License-Identifier: MIT
"""Proof that both discs stand, before anybody is asked to touch the rig."""

from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np

from rig.clock import Clock
from rig.errors import NotAtRest
from rig.experiment.readings import Batch

WINDOW: Final = 0.25
"""Time over which each disc's speed is averaged; by default no reading may be older [s]."""
FEWEST: Final = 5
"""New readings of each disc that there must be in the window."""
SCATTER: Final = 5.0
"""Root mean square that noise of an encoder may have, over the limit of the mean [-]."""
DISCS: Final[tuple[str, ...]] = ("leg", "ground")


class RestProof:
    """Collects new readings of both discs' speeds and tells whether they prove standstill.

    The mean over a window is judged, because an encoder's noise may well be larger than the limit.
    The root mean square is bounded, because a disc that swings to and fro has no mean either.

    Args:
        limit: Largest mean speed of a disc that stands [rad/s].
        oldest: Largest age of a reading that proves anything [s].
    """

    def __init__(self, limit: float, *, oldest: float = WINDOW) -> None:
        self._limit = limit
        self._oldest = oldest
        self._began: float | None = None
        self._seen: dict[str, deque[tuple[float, float]]] = {disc: deque() for disc in DISCS}

    def take(self, batch: Batch, *, now: float) -> None:
        """Take what a look gave; readings that waited too long begin the proof anew.

        Args:
            batch: The look.
            now: Host time [s].
        """
        first = min((float(t.min(initial=now)) for t in batch.taken.values()), default=now)
        if self._began is None or now - first > self._oldest:
            self._began = now
        for disc, seen in self._seen.items():
            seen.extend((now, speed) for speed in batch.speeds[disc].tolist())
            while seen and (seen[0][0] < self._began or seen[0][0] < now - WINDOW):
                seen.popleft()

    def holds(self, *, now: float) -> bool:
        """Return whether both discs are seen to stand over a whole window up to now [s]."""
        whole = self._began is not None and now - self._began >= WINDOW
        return whole and all(not self._problem(disc) for disc in DISCS)

    def failure(self, *, waited: float) -> NotAtRest:
        """Say which disc does not stand, or that too little came to tell.

        Args:
            waited: How long the proof was tried [s].
        """
        for disc in DISCS:
            if problem := self._problem(disc):
                break
        else:
            disc, problem = DISCS[0], f"its new readings do not cover {WINDOW:g} s"
        return NotAtRest(
            f"{disc} disc did not come to rest within {waited:.3g} s: {problem}", limit=self._limit
        )

    def _problem(self, disc: str) -> str:
        """Say why a disc is not seen to stand; empty where it is."""
        speeds = np.array([speed for _, speed in self._seen[disc]])
        if len(speeds) < FEWEST:
            return (
                f"{len(speeds)} readings of its speed in {WINDOW:g} s that are not older than "
                f"{self._oldest:g} s, expected {FEWEST}"
            )
        mean, scatter = float(speeds.mean()), float(np.sqrt(np.mean(speeds**2)))
        if not abs(mean) <= self._limit:
            return f"its mean speed over {WINDOW:g} s is {mean:.3g} rad/s"
        if not scatter <= SCATTER * self._limit:
            return f"its speed swings about zero by {scatter:.3g} rad/s"
        return ""


def prove_rest(
    look: Callable[[], Batch],
    limit: float,
    *,
    longest: float,
    clock: Clock,
    oldest: float = WINDOW,
) -> None:
    """Look at a rig until both discs are proved to stand.

    Args:
        look: Waits a little and gives what has come since.
        limit: Largest mean speed of a disc that stands [rad/s].
        longest: When to give up [s].
        clock: Host time.
        oldest: Largest age of a reading that proves anything [s].

    Raises:
        NotAtRest: They are not seen to stand in time.
    """
    proof, began = RestProof(limit, oldest=oldest), clock.now()
    while not proof.holds(now=clock.now()):
        if clock.now() - began >= longest:
            raise proof.failure(waited=clock.now() - began)
        proof.take(look(), now=clock.now())
