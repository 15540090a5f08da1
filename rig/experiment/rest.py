# SPDX-License-Identifier: MIT
"""Verify standstill of both discs before a person is asked to touch the rig."""

from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np

from rig.clock import Clock
from rig.errors import NotAtRest
from rig.experiment.readings import Batch

WINDOW: Final = 0.25
"""Time over which each disc's speed is averaged, and default largest age of a reading [s]."""
FEWEST: Final = 5
"""Least number of new readings of each disc in the window."""
SCATTER: Final = 5.0
"""Largest ratio of the root mean square of the speed to the limit of its mean, for noise [-]."""
DISCS: Final[tuple[str, ...]] = ("leg", "ground")


class RestProof:
    """Standstill detector: tests mean and root mean square of both discs' speeds over `WINDOW`.

    The mean over a window is tested, because an encoder's noise can exceed the limit. The root mean
    square is bounded as well, by `SCATTER` times the limit, because the mean speed of an
    oscillating disc is also small.

    Args:
        limit: Largest mean speed of a disc that stands [rad/s].
        oldest: Largest age of a usable reading [s].
    """

    def __init__(self, limit: float, *, oldest: float = WINDOW) -> None:
        self._limit = limit
        self._oldest = oldest
        self._began: float | None = None
        self._seen: dict[str, deque[tuple[float, float]]] = {disc: deque() for disc in DISCS}

    def take(self, batch: Batch, *, now: float) -> None:
        """Add the speeds of a batch; a reading in it older than `oldest` discards earlier batches.

        Args:
            batch: Samples of one poll of the rig.
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
        """Return whether both discs stood during the whole `WINDOW` before host time `now` [s].

        Each disc needs `FEWEST` readings in the window.
        """
        whole = self._began is not None and now - self._began >= WINDOW
        return whole and all(not self._problem(disc) for disc in DISCS)

    def failure(self, *, waited: float) -> NotAtRest:
        """Return an error that says why standstill is not verified, of the first disc that fails.

        Args:
            waited: Duration of the attempt [s].
        """
        for disc in DISCS:
            if problem := self._problem(disc):
                break
        else:
            disc, problem = DISCS[0], f"no {WINDOW:g} s of readings up to {self._oldest:g} s old"
        return NotAtRest(
            f"{disc} disc did not come to rest within {waited:.3g} s: {problem}", limit=self._limit
        )

    def _problem(self, disc: str) -> str:
        """Return why standstill of a disc is not verified, as text; empty where it is verified.

        It is with `FEWEST` readings or more in the window, a mean speed up to the limit, and a root
        mean square of the speed up to `SCATTER` times the limit.
        """
        speeds = np.array([speed for _, speed in self._seen[disc]])
        if len(speeds) < FEWEST:
            return (
                f"its speed was read {len(speeds)} times in {WINDOW:g} s, or since a reading was "
                f"last older than {self._oldest:g} s (expected {FEWEST} or more)"
            )
        mean, scatter = float(speeds.mean()), float(np.sqrt(np.mean(speeds**2)))
        if not abs(mean) <= self._limit:
            return f"its mean speed over {WINDOW:g} s is {mean:.3g} rad/s"
        if not scatter <= SCATTER * self._limit:
            return (
                f"its speed oscillates, with a root mean square of {scatter:.3g} rad/s (limit "
                f"{SCATTER * self._limit:.3g} rad/s)"
            )
        return ""


def prove_rest(
    poll: Callable[[], Batch],
    limit: float,
    *,
    longest: float,
    clock: Clock,
    oldest: float = WINDOW,
) -> None:
    """Poll a rig until standstill of both discs is verified.

    Args:
        poll: Waits one period and returns the new samples; its errors are passed on.
        limit: Largest mean speed of a disc that stands [rad/s].
        longest: Timeout [s].
        clock: Host time.
        oldest: Largest age of a usable reading [s].

    Raises:
        NotAtRest: Standstill was not verified in time.
    """
    proof, began = RestProof(limit, oldest=oldest), clock.now()
    while not proof.holds(now=clock.now()):
        if clock.now() - began >= longest:
            raise proof.failure(waited=clock.now() - began)
        proof.take(poll(), now=clock.now())
