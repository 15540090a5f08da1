# SPDX-License-Identifier: MIT
"""What an adaptive experiment is after: targets, and how narrow their intervals shall become."""

import math
from dataclasses import dataclass
from typing import Final

from typer import BadParameter

from zebro_lab.suggest.target_text import TargetText, parse_target

HINT: Final = "'--adaptive'"
"""The option that an error names."""


@dataclass(frozen=True)
class Wanted:
    """A target and the half width that its 90 % interval shall have.

    Attributes:
        text: The target as written, without the half width.
        target: The target, parsed.
        half_width: Half width, in the parameter's unit or, of a force, relative to its size; None
            where the target only says what to measure.
    """

    text: str
    target: TargetText
    half_width: float | None


def parse_wanted(text: str) -> Wanted:
    """Parse a value of `--adaptive`, TARGET or TARGET=HALF_WIDTH.

    Raises:
        BadParameter: It has another form, or its half width is not above 0.

    >>> parse_wanted("slip_stiffness=0.3").half_width
    0.3
    >>> parse_wanted("force@0.02,0.2:8").half_width is None
    True
    """
    if text.startswith("walk:"):
        return Wanted(text, parse_target(text, option=HINT), None)
    name, equals, width = text.partition("=")
    if not equals:
        return Wanted(text, parse_target(text, option=HINT), None)
    try:
        number = float(width)
    except ValueError:
        number = math.nan
    if not 0 < number < math.inf:
        raise BadParameter(
            f"'{text}' has a half width of '{width}'; expected a number above 0, as in "
            "slip_stiffness=0.3 or, relative to the force, force@0.02=0.05",
            param_hint=HINT,
        )
    return Wanted(name, parse_target(name, option=HINT), number)
