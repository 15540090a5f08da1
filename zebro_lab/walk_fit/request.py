# SPDX-License-Identifier: MIT
"""Options of a fit of tracked walks."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from typer import Option


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
    estimate_offset: Annotated[
        bool,
        Option(
            "--estimate-offset",
            help="Estimate from the motion how far each track's clock is behind that of its leg "
            "log, and add it to the track's times.",
        ),
    ] = False
