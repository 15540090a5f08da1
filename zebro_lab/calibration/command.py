# SPDX-License-Identifier: MIT
"""Fit rig data for `calibrate-slip` and print the results."""

import typer

from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.terminal.messages import say, wide_console

INTERRUPTED = 130


def fit_and_report(request: CalibrationRequest) -> bool:
    """Fit a slip law, write the calibration folder, print results; return whether it converged.

    Raises:
        Exit: The fit was stopped (exit code 130).
    """
    from zebro_lab.calibration.screen import print_calibration
    from zebro_lab.calibration.stage import Stopped, calibrate
    from zebro_lab.terminal.progress import progress_bar

    try:
        with progress_bar() as watcher:
            calibration, read = calibrate(request, watcher)
    except Stopped as stopped:
        say(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    print_calibration(wide_console(), calibration, read, request.out)
    return calibration.verdict.converged
