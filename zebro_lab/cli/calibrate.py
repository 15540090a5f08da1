# SPDX-License-Identifier: MIT
"""`calibrate-slip DATA…`: fit a slip curve to rig logs and say how far to trust it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.cli.errors import run
from zebro_lab.terminal.messages import say

if TYPE_CHECKING:
    from rich.console import Console

    from zebro_lab.stages.calibrate import CalibrationRequest

NOT_CONVERGED = 3
INTERRUPTED = 130

EPILOG = """
Examples:

calibrate-slip datasets/rig-sim

calibrate-slip data/ --out calibration --resume

calibrate-slip bench.csv --columns bench-columns.toml --load-sensitivity

calibrate-slip data/ --walks data/RUN1 --walks data/RUN2

calibrate-slip --walks data/RUN1 --walks data/RUN2 --out calibration

Tracked walks inform legs and floor: leg offsets, leg arc, steering, grip and slip stiffness.
Without DATA they are added to the finished calibration in --out.

Exit codes: 0 converged (read the verdict), 1 error, 2 usage, 3 not converged (results are written
and marked), 130 stopped (a checkpoint is kept for --resume).
"""

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


Data = Annotated[
    list[Path] | None, typer.Argument(help="Run folders, or files or folders of CSV or Parquet.")
]
Walks = Annotated[
    list[Path] | None,
    typer.Option(help="Run folder of a tracked walk that informs the fit; repeatable."),
]
Robot = Annotated[
    Path | None, typer.Option(help="robot.toml of the walks, in place of those in their folders.")
]
EstimateOffset = Annotated[
    bool,
    typer.Option(
        "--estimate-offset",
        help="Find in the motion how far each walk's track is behind its leg log's clock.",
    ),
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
    data: Data = None,
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
    walks: Walks = None,
    robot: Robot = None,
    estimate_offset: EstimateOffset = False,
) -> None:
    """Fit a slip curve to rig logs by Bayesian inference and say how far to trust it."""
    from zebro_lab.stages.calibrate import CalibrationRequest

    if not data:
        if not walks:
            raise typer.BadParameter("needed: rig data, or --walks and the --out of a calibration")
        _fit_walks(walks, out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset)
        return
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
    converged = _fit_and_report(request)
    if walks:
        _fit_walks(walks, out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset)
    if not converged:
        raise typer.Exit(NOT_CONVERGED)


def _fit_and_report(request: "CalibrationRequest") -> bool:
    """Fit, print, and tell whether the fit has converged."""
    from rich.console import Console

    from zebro_lab.cli.calibration_report import print_calibration
    from zebro_lab.cli.progress import progress_bar
    from zebro_lab.stages.calibrate import Stopped
    from zebro_lab.stages.calibrate import calibrate as fit

    try:
        with progress_bar(Console(stderr=True)) as watcher:
            calibration, read = fit(request, watcher)
    except Stopped as stopped:
        say(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    print_calibration(_console(), calibration, read, request.out)
    return calibration.verdict.converged


def _fit_walks(
    walks: list[Path],
    out: Path,
    robot: Path | None,
    *,
    seed: int,
    threads: int,
    estimate_offset: bool,
) -> None:
    """Fit walks beside a finished calibration and print what they said."""
    from rich.console import Console

    from zebro_lab.cli.progress import progress_bar
    from zebro_lab.cli.walks_report import print_walks
    from zebro_lab.stages.calibrate_walks import WalksRequest, calibrate_walks

    request = WalksRequest(
        tuple(walks), out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset
    )
    with progress_bar(Console(stderr=True)) as watcher:
        done = calibrate_walks(request, watcher)
    print_walks(_console(), done)


def _console() -> "Console":
    from rich.console import Console

    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=120)


def main() -> None:
    """Run `calibrate-slip`."""
    run(app)
