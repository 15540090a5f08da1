# SPDX-License-Identifier: MIT
"""`zebro-lab walk`: simulate a gait; `zebro-lab predict LEGLOG`: from measured leg angles."""

import typer

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.walk.request import PredictRequest, WalkRequest

EPILOG = """
Examples:

zebro-lab walk --gait tripod --steering 1.3 --slip thesis --duration 25 --figures

zebro-lab walk --touchdown-deg 50,37.8 --liftoff-deg 130,138 --slip coulomb:0.38
--duration 30 --out measured-angles

zebro-lab walk --gait suriana --tau-turn 0.1 --model thesis --slip thesis --duration 4.8 --animate

zebro-lab walk --gait tetrapod --model thesis --duration 9 --contacts

zebro-lab walk --gait "{1,4} < {2,5} < {3,6}" --tau-turn 0.1 --slip thesis --duration 20

zebro-lab walk --gait tripod --steering 1.3 --slip calibration --duration 25 --draws 300

zebro-lab walk program.toml --slip thesis --figures
"""

PREDICT_EPILOG = """
Examples:

zebro-lab predict legs.csv --slip calibration --out prediction --figures

zebro-lab predict legs.csv --slip calibration --draws 500 --out prediction

zebro-lab predict legs.csv --columns legs.toml --slip coulomb:0.38 --out prediction

zebro-lab predict legs.csv --slip calibration --draws 5000 --scheduler tcp://127.0.0.1:8786

LEGLOG holds t [s] and theta1 to theta6 [rad], pi/2 with the toe straight down, wrapped or not;
other names and units through a columns.toml beside it. docs/formats.md says more.

Draws are the same on this machine's cores and on a Dask cluster. --scheduler needs the extra
"cluster"; whoever reaches a scheduler can run any program on its workers: docs/cluster.md.
"""


@request_command(first=("program", "name", "duration", "slip", "out"))
def walk(request: WalkRequest, output: Output = TEXT) -> None:
    """Simulate a gait, or a program of several, and write path.csv, a band, pictures and a film."""
    from zebro_lab.walk import screen, stage

    if request.duration is None and request.program is None:
        raise typer.BadParameter("missing: the duration of the walk [s]", param_hint="'--duration'")
    request.require_slip()
    screen.run_and_report("walk", lambda watcher: stage.walk(request, watcher), request.out, output)


@request_command(first=("log", "out", "slip", "model", "robot"))
def predict(request: PredictRequest, output: Output = TEXT) -> None:
    """Predict the path from leg angles: FOLDER/path.csv, a band, pictures and an animation."""
    from zebro_lab.walk import screen, stage

    request.model.require_slip()
    folder = stage.prediction_folder(request)
    screen.run_and_report(
        "predict", lambda watcher: stage.predict(request, watcher), folder, output
    )
