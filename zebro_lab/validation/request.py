# SPDX-License-Identifier: MIT
"""Options of a validation."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from typer import Argument, Option


@dataclass(frozen=True)
class ValidateRequest:
    """Options of `zebro-lab validate`."""

    runs: Annotated[
        tuple[Path, ...], Argument(metavar="RUN", help="Run folders with prediction/ and track/.")
    ] = ()
    predicted: Annotated[
        tuple[Path, ...],
        Option(help="Walk folder, or a table with t [s], x, y [m] and yaw [rad]; repeatable."),
    ] = ()
    track: Annotated[
        tuple[Path, ...], Option(help="track.csv or its folder; one for each --predicted.")
    ] = ()
    out: Annotated[
        Path | None,
        Option(
            metavar="DIR",
            help="Validation folder to write; default: RUN/validation for one run, else "
            "validation.",
        ),
    ] = None
    anchor: Annotated[
        bool,
        Option(
            "--anchor/--no-anchor",
            help="Start each path from the first tracked pose, or leave it where it was predicted.",
        ),
    ] = True
    time_offset: Annotated[
        float,
        Option(
            metavar="SECONDS",
            help="Time by which the track's clock is behind, added to its times [s].",
        ),
    ] = 0.0
    estimate_offset: Annotated[
        bool,
        Option(
            "--estimate-offset",
            help="Estimate from the motion how far the track's clock is behind; the walk must "
            "have starts, stops or turns.",
        ),
    ] = False
    seed: Annotated[int, Option(min=0, help="Seed of all random numbers.")] = 1

    @property
    def folder(self) -> Path:
        """`--out` if given, else RUN/validation for a single run, else `validation`."""
        if self.out is not None:
            return self.out
        alone = len(self.runs) == 1 and not self.predicted
        return self.runs[0] / "validation" if alone else Path("validation")
