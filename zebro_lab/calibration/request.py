# SPDX-License-Identifier: MIT
"""Options of a calibration."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer


@dataclass(frozen=True)
class CalibrationRequest:
    """Options of `calibrate-slip`."""

    data: Annotated[
        tuple[Path, ...],
        typer.Argument(help="Run folders, or files or folders of CSV or Parquet."),
    ] = ()
    out: Annotated[Path, typer.Option(help="Calibration folder to write.")] = Path("calibration")
    columns: Annotated[
        Path | None, typer.Option(help="columns.toml to use in place of those beside the tables.")
    ] = None
    slip_definition: Annotated[
        str | None, typer.Option(help="Fit in this definition: material, travel or larger.")
    ] = None
    law: Annotated[
        str, typer.Option(help="Slip law: magic-formula, brush or coulomb-stribeck.")
    ] = "magic-formula"
    curvature: Annotated[
        str,
        typer.Option(
            help="Curvature E of the Magic Formula: auto compares; peak (the peak's slip grows "
            "with load); constant; or a fixed number."
        ),
    ] = "auto"
    load_sensitivity: Annotated[
        bool, typer.Option("--load-sensitivity", help="Friction and stiffness vary with load.")
    ] = False
    block_length: Annotated[
        int | None, typer.Option(min=1, help="Samples in a block mean; chosen from the data.")
    ] = None
    zero_stability: Annotated[
        float | None, typer.Option(min=0.0, help="Scale of the run offsets' spread [N].")
    ] = None
    gain_sd: Annotated[
        float | None, typer.Option(min=0.0, help="Relative gain error of the load cell (sd).")
    ] = None
    ensembles: Annotated[int, typer.Option(min=4, help="Independent emcee ensembles.")] = 4
    max_steps: Annotated[
        int, typer.Option(min=1, help="Give up on convergence after so many sampler moves.")
    ] = 30_000
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 1
    threads: Annotated[int, typer.Option(min=1, help="Ensembles advanced at once.")] = 2
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the stopped fit in --out.")
    ] = False

    @property
    def load_cell(self) -> dict[str, float]:
        """Properties of the load cell that replace those of `columns.toml`, by name."""
        given = {"zero_stability": self.zero_stability, "gain_sd": self.gain_sd}
        return {name: value for name, value in given.items() if value is not None}

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Files and folders that are read, as named."""
        return (*self.data, *((self.columns,) if self.columns is not None else ()))

    def decisive(self) -> dict[str, object]:
        """Return the settings that affect the results, JSON-serialisable."""
        return {
            "slip_definition": self.slip_definition,
            "law": self.law,
            "curvature": self.curvature,
            "load_sensitivity": self.load_sensitivity,
            "block_length": self.block_length,
            "load_cell": self.load_cell,
            "ensembles": self.ensembles,
            "seed": self.seed,
        }
