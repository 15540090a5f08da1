# SPDX-License-Identifier: MIT
"""`calibrate-slip DATA…`: fit a slip curve to rig logs and say how far to trust it."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.cli.errors import run

NOT_CONVERGED = 3
INTERRUPTED = 130

EPILOG = """
Examples:

calibrate-slip datasets/rig-sim

calibrate-slip data/ --out calibration --resume

calibrate-slip bench.csv --columns bench-columns.toml --load-sensitivity

Exit codes: 0 converged (read the verdict), 1 error, 2 usage, 3 not converged (results are written
and marked), 130 stopped (a checkpoint is kept for --resume).
"""

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG)
def calibrate(
    data: Annotated[
        list[Path], typer.Argument(help="Run folders, or files or folders of CSV or Parquet.")
    ],
    out: Annotated[Path, typer.Option(help="Calibration folder to write.")] = Path("calibration"),
    columns: Annotated[
        Path | None, typer.Option(help="columns.toml to use in place of those beside the tables.")
    ] = None,
    slip_definition: Annotated[
        str | None, typer.Option(help="Fit in this definition: material, travel or larger.")
    ] = None,
    law: Annotated[
        str, typer.Option(help="Slip law: magic-formula, brush or coulomb-stribeck.")
    ] = "magic-formula",
    curvature: Annotated[
        str,
        typer.Option(
            help="Curvature E of the Magic Formula: auto compares; peak (the peak's slip grows "
            "with load); constant; or a fixed number."
        ),
    ] = "auto",
    load_sensitivity: Annotated[
        bool, typer.Option("--load-sensitivity", help="Friction and stiffness vary with load.")
    ] = False,
    block_length: Annotated[
        int | None, typer.Option(min=1, help="Samples in a block mean; chosen from the data.")
    ] = None,
    zero_stability: Annotated[
        float | None, typer.Option(min=0.0, help="Scale of the run offsets' spread [N].")
    ] = None,
    gain_sd: Annotated[
        float | None, typer.Option(min=0.0, help="Relative gain error of the load cell (sd).")
    ] = None,
    ensembles: Annotated[int, typer.Option(min=4, help="Independent emcee ensembles.")] = 4,
    max_steps: Annotated[
        int, typer.Option(min=1, help="Give up on convergence after so many sampler moves.")
    ] = 30_000,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 1,
    threads: Annotated[int, typer.Option(min=1, help="Ensembles advanced at once.")] = 2,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the stopped fit in --out.")
    ] = False,
) -> None:
    """Fit a slip curve to rig logs by Bayesian inference and say how far to trust it."""
    from rich.console import Console

    from zebro_lab.cli.calibration_report import print_calibration
    from zebro_lab.cli.progress import progress_bar
    from zebro_lab.stages.calibrate import CalibrationRequest, Stopped
    from zebro_lab.stages.calibrate import calibrate as fit

    cell = {"zero_stability": zero_stability, "gain_sd": gain_sd}
    request = CalibrationRequest(
        data=tuple(data),
        out=out,
        columns=columns,
        slip_definition=slip_definition,
        law=law,
        curvature=curvature,
        load_sensitivity=load_sensitivity,
        block_length=block_length,
        load_cell={name: value for name, value in cell.items() if value is not None},
        ensembles=ensembles,
        max_steps=max_steps,
        seed=seed,
        threads=threads,
        resume=resume,
    )
    try:
        with progress_bar(Console(stderr=True)) as watcher:
            calibration, read = fit(request, watcher)
    except Stopped as stopped:
        typer.echo(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=120)
    print_calibration(console, calibration, read, out)
    if not calibration.verdict.converged:
        raise typer.Exit(NOT_CONVERGED)


def main() -> None:
    """Run `calibrate-slip`."""
    run(app)
