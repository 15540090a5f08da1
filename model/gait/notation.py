# SPDX-License-Identifier: MIT
"""Group notation of gaits, such as {1,4,5} ≺ {2,3,6}."""

import re
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.errors import DomainError

_GROUP = re.compile(r"\{([^{}]*)\}")
_MOST_DIGITS = 6  # of a leg number; int() itself fails beyond 4300


@dataclass(frozen=True, eq=False)
class Gait:
    r"""Groups of legs in the order in which they step, Eq. (2-1).

    .. math::
        \{L_{1,1}, \ldots, L_{1,j}\} \prec \ldots \prec \{L_{r,1}, \ldots, L_{r,p}\}

    Legs of one group move together; a group lifts off once the group to its left has touched
    down, and the first group once the last has. Section 2-2-1 has the reverse (once the group to
    its *right* has touched down), but the thesis's matrices P and Q and its tetrapod, Eq. (5-5) to
    (5-12), have this order; with two groups the orders are the same.

    A gait repeats, so groups that are rotated make an equal gait; legs of a group have no order.

    Attributes:
        groups: Leg numbers from 1, sorted, by group in the order of stepping.

    Raises:
        DomainError: There is no group, a group is empty, or the legs are not 1 to n, once each.

    >>> Gait(((2, 3, 6), (5, 4, 1))) == TRIPOD
    True
    """

    groups: tuple[tuple[int, ...], ...]

    def __post_init__(self) -> None:
        """Check groups and that each leg is in one; sort the legs within their groups."""
        if not self.groups:
            raise DomainError("the gait has no groups of legs; write one such as {1,4,5} < {2,3,6}")
        for number, group in enumerate(self.groups, start=1):
            if not group:
                raise DomainError(
                    f"group {number} of the gait is empty; write its legs, or leave it out"
                )
        _require_each_leg_once([leg for group in self.groups for leg in group])
        object.__setattr__(self, "groups", tuple(tuple(sorted(group)) for group in self.groups))

    @property
    def n_legs(self) -> int:
        """Number of legs."""
        return sum(len(group) for group in self.groups)

    @property
    def group_of(self) -> NDArray[np.int_]:
        """Index, from 0, of each leg's group in `groups`, shape (n,)."""
        found = np.empty(self.n_legs, dtype=int)
        for number, group in enumerate(self.groups):
            found[np.array(group) - 1] = number
        return found

    @property
    def _from_leg_1(self) -> tuple[tuple[int, ...], ...]:
        """Groups rotated so that the group of leg 1 is first."""
        first = int(self.group_of[0])
        return self.groups[first:] + self.groups[:first]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Gait) and self._from_leg_1 == other._from_leg_1

    def __hash__(self) -> int:
        return hash(self._from_leg_1)

    def __str__(self) -> str:
        return " ≺ ".join("{" + ",".join(map(str, group)) + "}" for group in self.groups)


def _require_each_leg_once(legs: list[int]) -> None:
    """Raise `DomainError` unless the leg numbers are 1 to n, once each."""
    twice = sorted(leg for leg, count in Counter(legs).items() if count > 1)
    if twice:
        raise DomainError(f"leg {twice[0]} is in the gait more than once; expected every leg once")
    if min(legs) < 1:
        raise DomainError(f"the gait contains leg {min(legs)}; expected leg numbers from 1")
    given = set(legs)
    missing = next((leg for leg in range(1, len(legs) + 1) if leg not in given), None)
    if missing is not None:
        raise DomainError(
            f"leg {missing} is missing from the gait, which names {len(legs)} legs up to "
            f"{max(legs)}; every leg steps once a cycle"
        )


def parse_gait(text: str, n_legs: int | None = None) -> Gait:
    """Parse a gait in group notation.

    Args:
        text: Groups of leg numbers in braces, with < or ≺ between them.
        n_legs: Number of legs that the gait must have; any number when None.

    Returns:
        The gait, its groups in the order of the text.

    Raises:
        DomainError: The text is not in group notation, a group is empty, its legs are not 1 to n,
            once each, or n is not `n_legs`.

    >>> print(parse_gait("{1,4} < {2,5} < {3,6}"))
    {1,4} ≺ {2,5} ≺ {3,6}
    """
    gait = Gait(tuple(_parse_group(part.strip(), text) for part in re.split("[<≺]", text)))
    if n_legs is not None and gait.n_legs != n_legs:
        raise DomainError(f"the gait {gait} has {gait.n_legs} legs; the robot has {n_legs}")
    return gait


def _parse_group(part: str, text: str) -> tuple[int, ...]:
    """Parse the leg numbers of one group, such as {1,4,5}, in their order; {} has none.

    Raise `DomainError` if it is no such group; `text` is the whole gait, for the message.
    """
    match = _GROUP.fullmatch(part)
    if match is None:
        raise DomainError(
            f"{part!r} in the gait {text!r} is not a group; write leg numbers in braces with < "
            "between groups, such as {1,4,5} < {2,3,6}"
        )
    inside = match[1].strip()
    legs = [word.strip() for word in inside.split(",")] if inside else []
    for leg in legs:
        if not leg.isdecimal():
            raise DomainError(
                f"{leg!r} in group {part} of the gait is not a leg number; expected 1, 2, 3 ..."
            )
        if len(leg) > _MOST_DIGITS:
            raise DomainError(
                f"a leg number in the gait has {len(leg)} digits; expected 1, 2, 3 ..., at most "
                f"{_MOST_DIGITS} digits"
            )
    return tuple(int(leg) for leg in legs)


TRIPOD = Gait(((1, 4, 5), (2, 3, 6)))  # Eq. (2-2)
TETRAPOD = Gait(((1, 4), (2, 5), (3, 6)))  # Eq. (2-3)
