# SPDX-License-Identifier: MIT
"""Options of a fit of tracked walks."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from typer import Option

from model.lateral_spread import ANISOTROPY
from zebro_lab.terminal.limits import Limits

MOST_ANISOTROPY: Final = 3.0
"""Largest factor by which lateral traction may be said to differ from longitudinal [-]."""


@dataclass(frozen=True)
class WalksRequest:
    """Options of `calibrate-slip` for a fit of tracked walks, beside those of the calibration."""

    walks: Annotated[
        tuple[Path, ...],
        Option(
            metavar="RUN",
            help="Run folder of a tracked walk, to fit legs and floor to; repeatable.",
        ),
    ] = ()
    robot: Annotated[
        Path | None,
        Option(metavar="FILE", help="robot.toml of the walks, instead of those in their folders."),
    ] = None
    estimate_offset: Annotated[
        bool,
        Option(
            "--estimate-offset",
            help="Estimate from the motion how far each track's clock is behind that of its leg "
            "log, and add it to the track's times.",
        ),
    ] = False
    anisotropy: Annotated[
        float,
        Option(
            metavar="FACTOR",
            help="Prior of lateral over longitudinal grip, and of lateral over longitudinal slip "
            "stiffness of the legs: 1 ×/÷ this factor each, one standard deviation; 1 for alike.",
        ),
        Limits(least=1, most=MOST_ANISOTROPY),
    ] = ANISOTROPY
