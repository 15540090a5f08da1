# SPDX-License-Identifier: MIT
"""Offset and drift of a device's clock in words, with as many digits as they are known to."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.clock_fit import DRIFT_SD

_SDS: Final = 2.0
"""Half width of an interval, in standard uncertainties."""
_PPM: Final = 1e6


def with_uncertainty(value: float, half_width: float) -> str:
    """Format a value and its uncertainty, both to the first two digits of the latter.

    Args:
        value: Value, in any unit.
        half_width: Half width of the interval around it, in the same unit.

    >>> with_uncertainty(324.4, 41.03), with_uncertainty(0.00173312, 0.0005)
    ('324 ± 41', '0.00173 ± 0.00050')
    """
    if not (half_width > 0 and np.isfinite(half_width)):
        return f"{value:g}"
    digits = 1 - int(np.floor(np.log10(half_width)))
    shown = max(digits, 0)
    return f"{round(value, digits):.{shown}f} ± {round(half_width, digits):.{shown}f}"


def clock_in_words(name: str, clock: Mapping[str, float]) -> str:
    """Return a sentence on the clock of a stream: pace, offset and delay.

    Args:
        name: Name of the stream.
        clock: Attributes of `ClockFit`.
    """
    offset = with_uncertainty(clock["offset"], _SDS * clock["offset_sd"])
    pace = (
        f"runs {_pace(clock)} than this computer's"
        if _tells_drift(clock)
        else "its pace is not testable in so short a time"
    )
    return (
        f"clock of {name}: {pace}, shows 0 s at {offset} s of the run; in half of the intervals of "
        f"50 ms even the quickest sample came more than {1e3 * clock['delay']:.2g} ms late"
    )


def _tells_drift(clock: Mapping[str, float]) -> bool:
    return clock["drift_sd"] < DRIFT_SD / 2


def _pace(clock: Mapping[str, float]) -> str:
    drift = with_uncertainty(_PPM * abs(clock["drift"]), _SDS * _PPM * clock["drift_sd"])
    return f"{drift} ppm {'slower' if clock['drift'] > 0 else 'faster'}"
