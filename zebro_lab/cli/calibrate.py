# SPDX-License-Identifier: MIT
"""`calibrate-slip DATA…`: fit a slip curve to rig logs and say how far to trust it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.cli.errors import run

if TYPE_CHECKING:
    from zebro_lab.stages.calibrate import CalibrationRequest

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


Data = Annotated[
    list[Path], typer.Argument(help="Run folders, or files or folders of CSV or Parquet.")
]
Out = Annotated[Path, typer.Option(help="Calibration folder to write.")]
Columns = Annotated[
    Path | None, typer.Option(help="columns.toml to use in place of those beside the tables.")
]
Definition = Annotated[
    str | None, typer.Option(help="Fit in this definition: material, travel or larger.")
]
Law = Annotated[str, typer.Option(help="Slip law: magic-formula, brush or coulomb-stribeck.")]
Curvature = Annotated[
    str,
    typer.Option(
        help="Curvature E of the Magic Formula: auto compares; peak (the peak's slip grows "
        "with load); constant; or a fixed number."
    ),
]
LoadSensitivity = Annotated[
    bool, typer.Option("--load-sensitivity", help="Friction and stiffness vary with load.")
]
BlockLength = Annotated[
    int | None, typer.Option(min=1, help="Samples in a block mean; chosen from the data.")
]
ZeroStability = Annotated[
    float | None, typer.Option(min=0.0, help="Scale of the run offsets' spread [N].")
]
GainSd = Annotated[
    float | None, typer.Option(min=0.0, help="Relative gain error of the load cell (sd).")
]
Ensembles = Annotated[int, typer.Option(min=4, help="Independent emcee ensembles.")]
MaxSteps = Annotated[
    int, typer.Option(min=1, help="Give up on convergence after so many sampler moves.")
]
Seed = Annotated[int, typer.Option(help="Seed of everything random.")]
Threads = Annotated[int, typer.Option(min=1, help="Ensembles advanced at once.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the stopped fit in --out.")]


@app.command(epilog=EPILOG)
def calibrate(
    data: Data,
    out: Out = Path("calibration"),
    columns: Columns = None,
    slip_definition: Definition = None,
    law: Law = "magic-formula",
    curvature: Curvature = "auto",
    load_sensitivity: LoadSensitivity = False,
    block_length: BlockLength = None,
    zero_stability: ZeroStability = None,
    gain_sd: GainSd = None,
    ensembles: Ensembles = 4,
    max_steps: MaxSteps = 30_000,
    seed: Seed = 1,
    threads: Threads = 2,
    resume: Resume = False,
) -> None:
    """Fit a slip curve to rig logs by Bayesian inference and say how far to trust it."""
    from zebro_lab.stages.calibrate import CalibrationRequest

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
    _fit_and_report(request)


def _fit_and_report(request: "CalibrationRequest") -> None:
    from rich.console import Console

    from zebro_lab.cli.calibration_report import print_calibration
    from zebro_lab.cli.progress import progress_bar
    from zebro_lab.stages.calibrate import Stopped
    from zebro_lab.stages.calibrate import calibrate as fit

    try:
        with progress_bar(Console(stderr=True)) as watcher:
            calibration, read = fit(request, watcher)
    except Stopped as stopped:
        typer.echo(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=120)
    print_calibration(console, calibration, read, request.out)
    if not calibration.verdict.converged:
        raise typer.Exit(NOT_CONVERGED)


def main() -> None:
    """Run `calibrate-slip`."""
    run(app)
