# SPDX-License-Identifier: MIT
"""`calibrate-slip DATA…`: fit a slip curve to rig data and report whether to trust it."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from zebro_lab.terminal.messages import say

if TYPE_CHECKING:
    from zebro_lab.calibration.stage import CalibrationRequest

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


class FitWalks(Protocol):
    """Fits tracked walks with a finished calibration and prints the results."""

    def __call__(
        self,
        walks: list[Path],
        out: Path,
        robot: Path | None,
        *,
        seed: int,
        threads: int,
        estimate_offset: bool,
    ) -> None:
        """Fit the walks; see `zebro_lab.walk_fit.command.fit_walks`."""


def calibrate_command(fit_walks: FitWalks) -> Callable[..., None]:
    """Create the command `calibrate-slip`.

    Args:
        fit_walks: Function that `--walks` calls; an argument, as this room must not import it.
    """

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
        """Fit a slip curve to rig data by Bayesian inference and report whether to trust it."""
        from zebro_lab.calibration.stage import CalibrationRequest

        if not data:
            if not walks:
                raise typer.BadParameter(
                    "needed: rig data, or --walks and the --out of a calibration"
                )
            fit_walks(
                walks, out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset
            )
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
            fit_walks(
                walks, out, robot, seed=seed, threads=threads, estimate_offset=estimate_offset
            )
        if not converged:
            raise typer.Exit(NOT_CONVERGED)

    return calibrate


def _fit_and_report(request: "CalibrationRequest") -> bool:
    """Fit and print the results; return whether the fit converged."""
    from rich.console import Console

    from zebro_lab.calibration.screen import print_calibration
    from zebro_lab.calibration.stage import Stopped
    from zebro_lab.calibration.stage import calibrate as fit
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.terminal.tables import wide_console

    try:
        with progress_bar(Console(stderr=True)) as watcher:
            calibration, read = fit(request, watcher)
    except Stopped as stopped:
        say(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    print_calibration(wide_console(), calibration, read, request.out)
    return calibration.verdict.converged
