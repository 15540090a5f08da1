# SPDX-License-Identifier: MIT
"""`zebro-lab predict LEGLOG`: predict the path from measured leg angles."""

from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.walk.request import PredictRequest

EPILOG = """
Examples:

zebro-lab predict legs.csv --slip calibration --out prediction --figures

zebro-lab predict legs.csv --slip calibration --draws 500 --out prediction

zebro-lab predict legs.csv --columns legs.toml --slip coulomb:0.38 --arc-deg 200 --out prediction

zebro-lab predict legs.csv --slip calibration --draws 5000 --scheduler tcp://127.0.0.1:8786

LEGLOG holds t [s] and theta1 to theta6 [rad], pi/2 with the toe straight down, wrapped or not;
other names and units through a columns.toml beside it. docs/formats.md says more.

Draws are the same on this machine's cores and on a Dask cluster. --scheduler needs the extra
"cluster"; whoever reaches a scheduler can run any program on its workers: docs/cluster.md.
"""


@request_command(first=("log", "out", "slip", "model", "robot", "arc_deg"))
def predict(request: PredictRequest, output: Output = TEXT) -> None:
    """Predict the path from leg angles: FOLDER/path.csv, a band, pictures and an animation."""
    from zebro_lab.walk import predict_stage
    from zebro_lab.walk.screen import run_and_report

    request.model.require_slip()
    folder = predict_stage.prediction_folder(request)
    run_and_report(
        "predict", lambda watcher: predict_stage.predict(request, watcher), folder, output
    )
