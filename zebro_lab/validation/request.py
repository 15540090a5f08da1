# SPDX-License-Identifier: MIT
"""Options of a validation."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer


@dataclass(frozen=True)
class ValidateRequest:
    """Options of `zebro-lab validate`."""

    runs: Annotated[
        tuple[Path, ...], typer.Argument(help="Run folders with prediction/ and track/.")
    ] = ()
    predicted: Annotated[
        tuple[Path, ...],
        typer.Option(help="Walk folder of predict, or a table with t, x, y, yaw; repeatable."),
    ] = ()
    track: Annotated[
        tuple[Path, ...], typer.Option(help="track.csv, or its folder; one a --predicted.")
    ] = ()
    out: Annotated[
        Path | None,
        typer.Option(help="Validation folder; RUN/validation of one run, else validation."),
    ] = None
    anchor: Annotated[
        bool,
        typer.Option(
            "--anchor/--no-anchor",
            help="Start from the first tracked pose; or take paths where they are.",
        ),
    ] = True
    time_offset: Annotated[
        float, typer.Option(help="Added to the track's times: its clock is so far behind [s].")
    ] = 0.0
    estimate_offset: Annotated[
        bool,
        typer.Option(
            "--estimate-offset",
            help="Find in the motion how far the track's clock is behind: starts, stops and turns "
            "tell it, an even walk does not.",
        ),
    ] = False
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 1

    @property
    def folder(self) -> Path:
        """Folder to write: `out`, else `validation`, in the run if one run is validated."""
        if self.out is not None:
            return self.out
        alone = len(self.runs) == 1 and not self.predicted
        return self.runs[0] / "validation" if alone else Path("validation")
