# SPDX-License-Identifier: MIT
"""Options of `zebro-lab rig suggest`."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, TypeAlias

from typer import Argument, BadParameter, Option

from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import Range

LONGEST_TIME: Final = 360_000.0
"""Longest `--time`, a hundred hours [s]."""
HIGHEST_RATE: Final = 1e5
"""Highest `--rate` [Hz]."""
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


@dataclass(frozen=True)
class SuggestRequest:
    """Options of `zebro-lab rig suggest`."""

    plan: Annotated[
        Path,
        Argument(
            metavar="PLAN",
            help="Plan (TOML) whose loads, range of slips, settling, controls and limits are kept.",
        ),
    ]
    calibration: Annotated[
        Path,
        Option(metavar="DIR", help="Calibration of what was measured so far."),
    ]
    target: Annotated[
        tuple[str, ...],
        Option(
            metavar="TARGET",
            help="What should become less uncertain: a parameter of the law (slip_stiffness, "
            "friction and others), traction at slips, force@0.02,0.2 or with a load "
            "force@0.02:8, or the end pose of a walk, walk:RUN; may be repeated.",
        ),
    ] = ()
    time: Annotated[
        float | None,
        Option(metavar="SECONDS", help="Time that the plan may take [s]; default: that of PLAN."),
        Range(above=0.0, most=LONGEST_TIME),
    ] = None
    alone: Annotated[
        bool,
        Option("--alone", help="Fit the further runs without the calibration's data."),
    ] = False
    rig: Annotated[
        str, Option(metavar="PROFILE", help="Profile of the rig; sim: rig-board-serial.")
    ] = "sim"
    rate: Annotated[
        float | None,
        Option(metavar="HERTZ", help="Sample rate [Hz]; default: that of the rig's profile."),
        Range(above=0.0, most=HIGHEST_RATE),
    ] = None
    seed: Annotated[int, Option(help="Seed of the posterior's draws."), Range(least=0)] = 1
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write, with plan.toml.")] = Path(
        "plan-suggested"
    )
    form: FormatOption = "png"

    def __post_init__(self) -> None:
        """Raise `BadParameter` for a target of another form."""
        _ = self.targets

    @property
    def targets(self) -> tuple[TargetText, ...]:
        """The targets, parsed."""
        return tuple(map(parse_target, self.target))

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Paths that are read, as written."""
        walks = (each.path for each in self.targets if isinstance(each, WalkText))
        return (self.plan, self.calibration, *walks)


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
    """Parse `force@SLIP,…[:LOAD]`: slips that are not 0, at most 1, and a load above 0.

    Raises:
        BadParameter: The text has another form, or a number is outside these ranges.
    """
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
    """Return the error for a text of another form than a target's."""
    return BadParameter(f"'{text}' is no target; expected {EXPECTED}", param_hint=option)
