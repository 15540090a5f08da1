# SPDX-License-Identifier: MIT
"""Stated values that photographs contradict, and which of them cannot be told apart."""

from collections.abc import Sequence
from dataclasses import dataclass

_AS_LIKELY = 4.0  # log odds


@dataclass(frozen=True)
class SuspectValue:
    """A stated value that may be wrong.

    Attributes:
        what: The value in words, such as "the side of the robot's marker".
        finding: What it would have to be, as by `more_or_less`.
        log_odds: Log of how much likelier the photographs are if this value alone is off by far
            more than its standard deviation [-].
    """

    what: str
    finding: str
    log_odds: float


def more_or_less(off: float, unit: str) -> str:
    """Format how far a value would be from the stated one.

    >>> more_or_less(-2.44, " mm")
    '2.4 mm less than stated'
    """
    return f"{abs(off):.1f}{unit} {'more' if off > 0 else 'less'} than stated"


def suspicion(suspects: Sequence[SuspectValue], *, remarkable: float) -> tuple[str, ...]:
    """Format a warning that names the likeliest suspect, and those hardly less likely.

    Args:
        suspects: All values that were tried.
        remarkable: Log odds from which a suspect is named. The more values are tried, the higher
            they rise by chance [-].

    Returns:
        One sentence; none where no suspect is remarkable.
    """
    ranked = sorted(suspects, key=lambda each: -each.log_odds)
    if not ranked or ranked[0].log_odds < remarkable:
        return ()
    best, *others = ranked
    text = f"{best.what} does not fit the photographs: it seems to be {best.finding}"
    rivals = [
        f"{each.what} ({each.finding})"
        for each in others
        if each.log_odds > best.log_odds - _AS_LIKELY
    ]
    if rivals:
        text += f"; this cannot be told apart from {', or '.join(rivals)}"
    return (f"{text}; measure again",)
