# SPDX-License-Identifier: MIT
"""Parse the option `--target`: a parameter of the law, traction at slips, or the end of a walk."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeAlias

from typer import BadParameter

FORCE: Final = "force"
WALK: Final = "walk"
EXPECTED: Final = (
    "a parameter of the law such as slip_stiffness, force@SLIP,…[:LOAD] or walk:RUN (a run, a walk "
    "folder or a leg log)"
)
TARGET: Final = "'--target'"
"""The option that an error names."""


@dataclass(frozen=True)
class ParameterText:
    """A parameter of the law, by name."""

    name: str


@dataclass(frozen=True)
class ForceText:
    """Traction at slip ratios [-], at one load [N] or, without, at those of the plan."""

    slips: tuple[float, ...]
    load: float | None


@dataclass(frozen=True)
class WalkText:
    """The end pose of a walk whose leg angles are read from a path."""

    path: Path


TargetText: TypeAlias = ParameterText | ForceText | WalkText


def parse_target(text: str, *, option: str = TARGET) -> TargetText:
    """Parse a target.

    Args:
        text: The target.
        option: The option that an error names, in quotation marks.

    Raises:
        BadParameter: The text has another form, or a number is not possible.

    >>> parse_target("force@0.02,0.2:8")
    ForceText(slips=(0.02, 0.2), load=8.0)
    >>> parse_target("friction")
    ParameterText(name='friction')
    """
    if text.startswith(f"{WALK}:"):
        path = text.removeprefix(f"{WALK}:")
        if not path:
            raise _refused(text, option)
        return WalkText(Path(path))
    if text == FORCE or text.startswith(f"{FORCE}@"):
        return _force(text, option)
    if not text.isidentifier():
        raise _refused(text, option)
    return ParameterText(text)


def _force(text: str, option: str) -> ForceText:
    slips, colon, load = text.removeprefix(FORCE).removeprefix("@").partition(":")
    try:
        numbers = tuple(float(each) for each in slips.split(","))
        newtons = float(load) if colon else None
    except ValueError:
        raise _refused(text, option) from None
    if not all(map(math.isfinite, numbers)) or max(numbers) > 1 or 0 in numbers:
        raise BadParameter(
            f"'{text}' has slips {slips}; expected slip ratios of at most 1 that are not 0, where "
            "there is no traction to be known",
            param_hint=option,
        )
    if newtons is not None and not (newtons > 0 and math.isfinite(newtons)):
        raise BadParameter(f"'{text}' has a load of {load} N; expected above 0", param_hint=option)
    return ForceText(numbers, newtons)


def _refused(text: str, option: str) -> BadParameter:
    return BadParameter(f"'{text}' is no target; expected {EXPECTED}", param_hint=option)
