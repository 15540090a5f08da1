# SPDX-License-Identifier: MIT
"""`calibrate-slip DATA…`: fit a slip curve to rig data, and legs and floor to tracked walks."""

import typer

from zebro_lab.calibration.command import fit_and_report
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.terminal.messages import wide_console
from zebro_lab.terminal.request_command import request_command
from zebro_lab.terminal.version import Version
from zebro_lab.walk_fit.request import WalksRequest

NOT_CONVERGED = 3

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


@request_command()
def calibrate(request: CalibrationRequest, tracked: WalksRequest, version: Version = False) -> None:
    """Fit a slip curve to rig data by Bayesian inference and report whether to trust it."""
    if not (request.data or tracked.walks):
        raise typer.BadParameter(
            "missing: rig data, or --walks and the --out of a finished calibration"
        )
    if request.data and tracked.walks:
        _require_walks(tracked, request)
    converged = fit_and_report(request) if request.data else True
    if tracked.walks:
        _fit_walks(tracked, request)
    if not converged:
        raise typer.Exit(NOT_CONVERGED)


def _require_walks(tracked: WalksRequest, calibration: CalibrationRequest) -> None:
    """Check the walks before a fit of rig data, which takes long and replaces files."""
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.walk_fit.stage import require_walks

    with progress_bar() as watcher:
        require_walks(tracked, calibration, watcher)


def _fit_walks(tracked: WalksRequest, calibration: CalibrationRequest) -> None:
    """Fit leg offsets and floor parameters to tracked walks, write `walks/`, print the results."""
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.walk_fit.screen import print_walks
    from zebro_lab.walk_fit.stage import calibrate_walks

    with progress_bar() as watcher:
        done = calibrate_walks(tracked, calibration, watcher)
    print_walks(wide_console(), done)
