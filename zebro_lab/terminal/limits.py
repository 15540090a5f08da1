# SPDX-License-Identifier: MIT
"""Range of the numbers that options take: one value that is checked and shown in the help."""

import math
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Range:
    """Range of a number; it stands beside the `typer.Option` in the annotation of a field.

    A limit that belongs to the range may as well be given as `min` or `max` of the option. NaN and
    infinity are outside every range.

    Attributes:
        least: Smallest number of the range; None for no limit.
        most: Largest number of the range.
        above: Number that all numbers of the range exceed.
        below: Number that exceeds all numbers of the range.
        advice: What to do about a number outside; empty for nothing.

    >>> str(Range(least=90, below=360)), str(Range(above=0)), str(Range(least=1, most=6))
    ('90 or more and below 360', 'above 0', '1 to 6')
    >>> Range(above=0).hold(0.0), Range().hold(float("nan"))
    (False, False)
    """

    least: float | None = None
    most: float | None = None
    above: float | None = None
    below: float | None = None
    advice: str = ""

    def hold(self, number: float) -> bool:
        """Return whether a number is finite and within the limits."""
        return (
            math.isfinite(number)
            and (self.least is None or number >= self.least)
            and (self.most is None or number <= self.most)
            and (self.above is None or number > self.above)
            and (self.below is None or number < self.below)
        )

    def __str__(self) -> str:
        """Describe the range in words; empty without limits."""
        if self.least is not None and self.most is not None:
            return f"{self.least:g} to {self.most:g}"
        return " and ".join(self._parts())

    def _parts(self) -> Iterator[str]:
        if self.least is not None:
            yield f"{self.least:g} or more"
        if self.above is not None:
            yield f"above {self.above:g}"
        if self.most is not None:
            yield f"at most {self.most:g}"
        if self.below is not None:
            yield f"below {self.below:g}"
