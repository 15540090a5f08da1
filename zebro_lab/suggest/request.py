# SPDX-License-Identifier: MIT
"""Options of `zebro-lab rig suggest`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from typer import Argument, Option

from zebro_lab.suggest.target_text import TargetText, WalkText, parse_target
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import Range

LONGEST_TIME: Final = 360_000.0
"""Longest `--time`, a hundred hours [s]."""
HIGHEST_RATE: Final = 1e5
"""Highest `--rate` [Hz]."""


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
    seed: Annotated[int, Option(min=0, help="Seed of the posterior's draws.")] = 1
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
