# SPDX-License-Identifier: MIT
"""Interface of every gait: leg angles as functions of time."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.compiled import compiled
from model.errors import DomainError


class LegReference(Protocol):
    """Angles and speeds of six legs over time.

    Angles are unwrapped: that of a leg that walks forward never falls, and grows by 2 pi a cycle.
    """

    @property
    def period(self) -> float | None:
        """Period [s], in which every leg turns by 2 pi and the motion repeats; None if never."""
        ...

    def angles(self, t: ArrayLike) -> Array:
        """Compute the unwrapped leg angles at times t, shape (n,) [s]; shape (n, 6) [rad]."""
        ...

    def speeds(self, t: ArrayLike) -> Array:
        """Compute leg speeds at times t [s], at a kink those after it, shape (n, 6) [rad/s]."""
        ...


@dataclass(frozen=True)
class SampledReference:
    """Leg angles at given times with linear interpolation: a measured log, or any table.

    Attributes:
        t: Times, strictly increasing, shape (m,) [s].
        theta: Unwrapped leg angles, shape (m, 6) [rad].

    Raises:
        DomainError: The times do not increase, there are fewer than two, or shapes do not match.
    """

    t: Array
    theta: Array

    def __post_init__(self) -> None:
        """Check that shapes match and that there are two times or more, which increase."""
        if self.t.ndim != 1 or len(self.t) < 2 or self.theta.shape != (len(self.t), 6):
            raise DomainError(
                f"times have shape {self.t.shape} and leg angles {self.theta.shape}; "
                "expected (m,) and (m, 6) with m at least 2"
            )
        steps = np.diff(self.t)
        if not np.all(steps > 0):
            worst = int(np.argmin(steps > 0))
            raise DomainError(
                f"time goes from {self.t[worst]:g} to {self.t[worst + 1]:g} s after sample "
                f"{worst + 1} (the first is 1); expected increasing times"
            )

    @property
    def period(self) -> float | None:
        """None: a log does not repeat."""
        return None

    def angles(self, t: ArrayLike) -> Array:
        """Interpolate leg angles linearly at times t [s], constant outside; shape (n, 6) [rad]."""
        at = np.atleast_1d(np.asarray(t, dtype=float))
        t, theta, at = (np.ascontiguousarray(a, dtype=float) for a in (self.t, self.theta, at))
        return _between(t, theta, at)

    def speeds(self, t: ArrayLike) -> Array:
        """Compute the slope of the angles just after times t [s], shape (n, 6) [rad/s].

        Zero before the first time and from the last one on.
        """
        at = np.atleast_1d(np.asarray(t, dtype=float))
        index = np.searchsorted(self.t, at, side="right") - 1
        slopes = np.diff(self.theta, axis=0) / np.diff(self.t)[:, None]
        padded = np.vstack([np.zeros(6), slopes, np.zeros(6)])
        return padded[index + 1]


@compiled
def _between(t, values, at):
    """Interpolate columns of `values` over t linearly at times `at`, constant outside.

    Fast where the times `at` increase.
    """
    out = np.empty((len(at), values.shape[1]))
    last, j = len(t) - 1, 0
    for i in range(len(at)):
        if at[i] < t[j]:
            j = 0
        while j < last - 1 and at[i] >= t[j + 1]:
            j += 1
        share = (at[i] - t[j]) / (t[j + 1] - t[j])
        for k in range(values.shape[1]):
            low, high = values[j, k], values[j + 1, k]
            inside = low + share * (high - low)
            out[i, k] = low if share <= 0 else (high if share >= 1 else inside)
    return out
