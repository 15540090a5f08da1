# SPDX-License-Identifier: MIT
"""`zebro-lab predict LEGLOG`: predict the path from measured leg angles."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.walk.options import (
    Animate,
    ArcDeg,
    Direction,
    Draws,
    Figures,
    Model,
    ModelName,
    OffsetSdDeg,
    RobotFile,
    Seed,
    Slip,
    StartSd,
    StepLength,
    Threads,
    Toe,
    ToeName,
    require_slip,
)

EPILOG = """
Examples:

zebro-lab predict legs.csv --slip calibration --out prediction --figures

zebro-lab predict legs.csv --slip calibration --draws 500 --out prediction

zebro-lab predict legs.csv --columns legs.toml --slip coulomb:0.38 --arc-deg 200 --out prediction

LEGLOG holds t [s] and theta1 to theta6 [rad], pi/2 with the toe straight down, wrapped or not;
other names and units through a columns.toml beside it. docs/formats.md says more.
"""


def predict(
    leglog: Annotated[
        Path,
        typer.Argument(help="Leg angles over time: CSV, Parquet, a recorded run or a walk folder."),
    ],
    out: Annotated[
        Path | None,
        typer.Option(help="Walk folder to write; RUN/prediction of a run, else prediction."),
    ] = None,
    slip: Slip = None,
    model: ModelName = Model.DYNAMICS,
    toe: ToeName = Toe.SATURATED,
    robot: RobotFile = None,
    arc_deg: ArcDeg = None,
    columns: Annotated[
        Path | None, typer.Option(help="columns.toml to use in place of that beside LEGLOG.")
    ] = None,
    direction: Annotated[
        Direction, typer.Option(help="Side the gait turns to; only --model thesis asks.")
    ] = Direction.LEFT,
    dt: StepLength = None,
    draws: Draws = 0,
    seed: Seed = 1,
    offset_sd_deg: OffsetSdDeg = None,
    start_sd: StartSd = (0.0, 0.0, 0.0),
    threads: Threads = 2,
    figures: Figures = False,
    animate: Animate = False,
) -> None:
    """Predict the path from leg angles: FOLDER/path.csv, a band, pictures and an animation."""
    from zebro_lab.runs.recorded_legs import is_recorded
    from zebro_lab.walk.folder import PREDICTION
    from zebro_lab.walk.path_band import BandRequest
    from zebro_lab.walk.predict_stage import PredictRequest
    from zebro_lab.walk.predict_stage import predict as run
    from zebro_lab.walk.screen import run_and_report
    from zebro_lab.walk.walking import ModelRequest

    require_slip(model, slip)
    if out is None:
        out = leglog / PREDICTION if is_recorded(leglog) else Path(PREDICTION)
    request = PredictRequest(
        log=leglog,
        model=ModelRequest(
            out=out,
            slip=slip,
            model=model.value,
            toe=toe.value,
            robot=robot,
            arc_deg=arc_deg,
            dt=dt,
            figures=figures,
            animate=animate,
        ),
        columns=columns,
        direction=direction.value,
        band=BandRequest(draws, seed, offset_sd_deg, start_sd, threads=threads) if draws else None,
    )
    run_and_report(lambda watcher: run(request, watcher), request.model)
