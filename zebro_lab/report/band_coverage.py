# SPDX-License-Identifier: MIT
"""Find which shares of tracked values inside a predicted band are out of their range."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from model.metrics.scores import coverage_range

LEVELS = (50, 90, 95)  # per cent
STATES = ("x", "y", "yaw")


@dataclass(frozen=True)
class OutOfRange:
    """A share of tracked values inside a band that is out of its binomial range.

    Attributes:
        level: Probability of the band [%].
        state: "x", "y" or "yaw".
        key: Key of the share in the metrics of a prediction.
        low: Lowest share of the central 95 % range for independent poses [%].
        high: Highest share of that range [%].
    """

    level: int
    state: str
    key: str
    low: float
    high: float


def out_of_range(row: Mapping[str, object]) -> Iterator[OutOfRange]:
    """Yield each coverage of a prediction that is outside of `model.metrics.coverage_range`.

    Args:
        row: Metrics of the prediction as in a validation's manifest, with `poses`; those that are
            missing or no number are passed over.
    """
    poses = _number(row.get("poses"))
    if poses is None or poses < 1:
        return
    for level in LEVELS:
        low, high = coverage_range(level / 100, int(poses))
        for state in STATES:
            key = f"coverage{level}_{state}"
            share = _number(row.get(key))
            if share is not None and not low - 1e-9 <= share <= high + 1e-9:
                yield OutOfRange(level, state, key, 100 * low, 100 * high)


def _number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)
