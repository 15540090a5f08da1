# SPDX-License-Identifier: MIT
"""Fit rig data for `calibrate-slip` and print the results."""

import typer

from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.terminal.messages import say
from zebro_lab.terminal.output import TEXT, Output

INTERRUPTED = 130


def fit_and_report(request: CalibrationRequest, output: Output = TEXT) -> bool:
    """Fit a slip law, write its folder, print the results; return whether the fit converged.

    Raises:
        Exit: The fit was stopped (exit code 130); a line on stderr says so.
        ZebroLabError, ModelError: As in `zebro_lab.calibration.stage.calibrate`.
    """
    from zebro_lab.calibration.screen import print_calibration
    from zebro_lab.calibration.stage import Stopped, calibrate

    try:
        with output.progress() as watcher:
            calibration, read = calibrate(request, watcher)
    except Stopped as stopped:
        say(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    print_calibration(output.console(), calibration, read, request.out)
    return calibration.verdict.converged
