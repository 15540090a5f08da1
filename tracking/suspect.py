# SPDX-License-Identifier: MIT
"""Stated values that photographs contradict, and which of them cannot be told apart."""

from collections.abc import Sequence
from dataclasses import dataclass

REMARKABLE = 2.5
"""Log odds above which a stated value is suspected [-]."""

_AS_LIKELY = 3.0  # log odds


@dataclass(frozen=True)
class Suspect:
    """A stated value that may be wrong.

    Attributes:
        what: The value in words, such as "the side of the robot's marker".
        finding: What it would have to be, such as "2.4 mm less than stated".
        log_odds: Log of how much likelier the photographs are if this value alone is off by far
            more than its standard deviation [-].
    """

    what: str
    finding: str
    log_odds: float


def suspicion(suspects: Sequence[Suspect]) -> tuple[str, ...]:
    """Format a warning that names the likeliest suspect, and those hardly less likely.

    Args:
        suspects: All values that were tried.

    Returns:
        One sentence; none where no suspect is remarkable.
    """
    ranked = sorted(suspects, key=lambda each: -each.log_odds)
    if not ranked or ranked[0].log_odds < REMARKABLE:
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
