# SPDX-License-Identifier: MIT
"""`calibrate-slip DATA…`: fit a slip curve to rig data, and legs and floor to tracked walks."""

import typer

from zebro_lab.calibration.command import fit_and_report
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.files.documents import read_json_document, read_toml_document
from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.command_classes import Version
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.walk_fit.request import WalksRequest
from zebro_lab.workers import open_executor

NOT_CONVERGED = 3

EPILOG = """
Examples:

calibrate-slip datasets/rig-sim

calibrate-slip data/ --out calibration --resume

calibrate-slip data/ --engine laplace --out first-look

calibrate-slip bench.csv --columns bench-columns.toml --load-sensitivity

calibrate-slip data/ --prior "friction = 0.40 ± 0.05"

calibrate-slip data/ --prior-from calibration-last-year --carry law --out calibration-this-year

calibrate-slip data/ --walks data/RUN1 --walks data/RUN2

calibrate-slip --walks data/RUN1 --walks data/RUN2 --out calibration

calibrate-slip data/ --law compare --scheduler tcp://127.0.0.1:8786

Tracked walks inform legs and floor: leg offsets, leg arc, steering, grip and slip stiffness.
Without DATA they are added to the finished calibration in --out.

--scheduler hands fits without left-out runs and loads, and the walks of --walks, to a Dask cluster,
with the same numbers (extra "cluster"; whoever reaches a scheduler can run any program on its
workers: docs/cluster.md).

Exit codes: 0 converged (read the verdict), 1 error, 2 usage, 3 not converged (results are written
and marked), 130 stopped (a checkpoint is kept for --resume).
"""


@request_command()
def calibrate(
    context: typer.Context,
    request: CalibrationRequest,
    tracked: WalksRequest,
    output: Output = TEXT,
    version: Version = False,
) -> None:
    """Fit a slip curve to rig data by Bayesian inference and report whether to trust it."""
    if not (request.data or tracked.walks):
        raise typer.BadParameter(
            "missing: rig data, or --walks and the --out of a finished calibration"
        )
    with open_executor(request.workers) as executor:  # a wrong address is told at once
        if request.data and tracked.walks:
            from zebro_lab.walk_fit.stage import require_walks

            with output.progress() as watcher:  # before a fit, which takes long and replaces files
                require_walks(tracked, request, watcher)
        converged = fit_and_report(request, output, executor=executor) if request.data else True
        if tracked.walks:
            from zebro_lab.walk_fit import screen, stage

            with output.progress() as watcher:
                done = stage.calibrate_walks(tracked, request, watcher, executor=executor)
            screen.print_walks(output.console(), done)
    if output.as_json:
        code = 0 if converged else NOT_CONVERGED
        typed = "calibrate-slip" if context.parent is None else "calibrate"
        content = _document(request, with_walks=bool(tracked.walks))
        output.document(typed, content, exit_code=code)
    if not converged:
        raise typer.Exit(NOT_CONVERGED)


def _document(request: CalibrationRequest, *, with_walks: bool) -> dict[str, object]:
    """Return folder, whether its data are simulated, and the content of its slip.toml.

    With walks, the content of the manifest of its `walks/` is the entry `walks`.
    """
    slip = read_toml_document(request.out / "slip.toml")
    source = str(slip.get("source", ""))
    content = {"folder": request.out, "simulated": is_simulated(source), "calibration": slip}
    if with_walks:
        content["walks"] = read_json_document(request.out / "walks" / "manifest.json")
    return content
