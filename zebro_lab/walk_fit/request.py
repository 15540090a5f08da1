# SPDX-License-Identifier: MIT
"""Options of a fit of tracked walks."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer


@dataclass(frozen=True)
class WalksRequest:
    """Options of `calibrate-slip --walks`, beside those of the calibration."""

    walks: Annotated[
        tuple[Path, ...],
        typer.Option(help="Run folder of a tracked walk that informs the fit; repeatable."),
    ] = ()
    robot: Annotated[
        Path | None,
        typer.Option(help="robot.toml of the walks, in place of those in their folders."),
    ] = None
    estimate_offset: Annotated[
        bool,
        typer.Option(
            "--estimate-offset",
            help="Find in the motion how far each walk's track is behind its leg log's clock.",
        ),
    ] = False
