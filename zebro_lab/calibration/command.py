# SPDX-License-Identifier: MIT
"""Fit rig data for `calibrate-slip` and print the results."""

import shlex
import sys
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

import typer

from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.terminal.messages import say
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.stopping import STOPPED


def fit_and_report(
    request: CalibrationRequest, output: Output = TEXT, *, executor: Executor | None
) -> bool:
    """Fit a slip law, write its folder, print the results; return whether the fit converged.

    Args:
        request: Options of the fit.
        output: How to print.
        executor: Computes the fits that leave out runs or loads; None for this process.

    Raises:
        Exit: The fit was stopped (exit code 130); a line on stderr says so.
        ZebroLabError, ModelError: As in `zebro_lab.calibration.stage.calibrate`.
    """
    from model.bayes.calibrate import FIRST_LOOK
    from zebro_lab.calibration.screen import print_calibration, print_data, print_preview
    from zebro_lab.calibration.stage import Stopped, calibrate, read, stated_notes

    with output.progress() as watcher:
        data = read(request, watcher)
    print_data(output.console(), data)  # before the fit, which takes a minute
    for note in stated_notes(request, data):
        output.say(note)
    if request.max_steps < FIRST_LOOK:
        output.say(
            f"--max-steps {request.max_steps} is fewer than the {FIRST_LOOK} sampler moves "
            f"before a fit is first judged; {FIRST_LOOK} are made"
        )
    console = output.console()
    try:
        with output.progress() as watcher:
            calibration, _ = calibrate(
                request, watcher, data,
                (lambda found: print_preview(console, found)) if request.engine == "auto"
                else (lambda _: None),
                executor=executor,
            )  # fmt: skip
    except Stopped as stopped:
        if stopped.checkpoint is None:
            say(str(stopped), err=True)
        else:
            say(
                f"stopped; {stopped.checkpoint} keeps the fit; go on with: {_resuming(sys.argv)}",
                err=True,
            )
        raise typer.Exit(STOPPED) from None
    print_calibration(output.console(), calibration, request.out)
    return calibration.verdict.converged


def _resuming(words: Sequence[str]) -> str:
    """Return the command line that resumes the fit of a command line.

    >>> _resuming(["/bin/calibrate-slip", "my data", "--out", "c"])
    "calibrate-slip 'my data' --out c --resume"
    """
    program, *given = words
    if "--resume" not in given:
        end_of_options = given.index("--") if "--" in given else len(given)
        given.insert(end_of_options, "--resume")
    return shlex.join([Path(program).name, *given])
