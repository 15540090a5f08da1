# SPDX-License-Identifier: MIT
"""`zebro-lab walk`: simulate a gait."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.terminal.messages import say
from zebro_lab.walk.options import (
    Animate,
    ArcDeg,
    Direction,
    Draws,
    Figures,
    Model,
    ModelName,
    OffsetSdDeg,
    Out,
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

if TYPE_CHECKING:
    from zebro_lab.walk.walking import ModelRequest

EPILOG = """
Examples:

zebro-lab walk --gait tripod --steering 1.3 --slip thesis --duration 25 --figures

zebro-lab walk --touchdown-deg 50,37.8 --liftoff-deg 130,138 --arc-deg 200 --slip coulomb:0.38
--duration 30 --out measured-angles

zebro-lab walk --gait suriana --tau-turn 0.1 --model thesis --slip thesis --duration 4.8 --animate

zebro-lab walk --gait tripod --steering 1.3 --slip calibration --duration 25 --draws 300

zebro-lab walk --write-robot robot.toml
"""


class GaitName(StrEnum):
    """The gaits."""

    TRIPOD = "tripod"
    SURIANA = "suriana"
    MAXPLUS = "maxplus"
    TETRAPOD = "tetrapod"
    BUEHLER = "buehler"


_PAIR = "INNER[,OUTER]"
GaitOption = Annotated[GaitName, typer.Option(help="How the legs take turns.")]
Steering = Annotated[
    float | None, typer.Option(help="Outer over inner stance angle of the tripod; 1 is straight.")
]
Side = Annotated[
    Direction | None, typer.Option(help="Where to turn, for tripod, suriana, maxplus.")
]
TouchdownDeg = Annotated[
    str | None, typer.Option(metavar=_PAIR, help="Leg angle at touchdown [deg].")
]
LiftoffDeg = Annotated[
    str | None,
    typer.Option(metavar=_PAIR, help="Leg angle at lift-off; the tripod's is computed [deg]."),
]
Cycle = Annotated[float | None, typer.Option(help="Cycle of tripod, tetrapod, buehler [s].")]
TauGround = Annotated[
    float | None, typer.Option(help="Time on the ground, for suriana, maxplus, buehler [s].")
]
TauFlight = Annotated[float | None, typer.Option(help="Time in flight, suriana, maxplus [s].")]
TauTurn = Annotated[
    float | None, typer.Option(help="How much longer inner legs stand, suriana, maxplus [s].")
]
Duration = Annotated[float | None, typer.Option(help="Time to walk [s].")]
WriteRobot = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write a robot.toml to edit, and stop.")
]


def walk(
    gait: GaitOption = GaitName.TRIPOD,
    duration: Duration = None,
    slip: Slip = None,
    out: Out = Path("walk"),
    steering: Steering = None,
    direction: Side = None,
    touchdown_deg: TouchdownDeg = None,
    liftoff_deg: LiftoffDeg = None,
    cycle: Cycle = None,
    tau_ground: TauGround = None,
    tau_flight: TauFlight = None,
    tau_turn: TauTurn = None,
    model: ModelName = Model.DYNAMICS,
    toe: ToeName = Toe.SATURATED,
    robot: RobotFile = None,
    arc_deg: ArcDeg = None,
    dt: StepLength = None,
    draws: Draws = 0,
    seed: Seed = 1,
    offset_sd_deg: OffsetSdDeg = None,
    start_sd: StartSd = (0.0, 0.0, 0.0),
    threads: Threads = 2,
    figures: Figures = False,
    animate: Animate = False,
    write_robot: WriteRobot = None,
) -> None:
    """Simulate a gait and write FOLDER/path.csv, a band, pictures and an animation."""
    from zebro_lab.robot.gait_argument import GaitRequest
    from zebro_lab.walk.path_band import BandRequest
    from zebro_lab.walk.screen import run_and_report
    from zebro_lab.walk.stage import WalkRequest
    from zebro_lab.walk.stage import walk as run
    from zebro_lab.walk.walking import ModelRequest

    asked = ModelRequest(
        out=out,
        slip=slip,
        model=model.value,
        toe=toe.value,
        robot=robot,
        arc_deg=arc_deg,
        dt=dt,
        figures=figures,
        animate=animate,
    )
    if write_robot is not None:
        _write_robot(write_robot, asked)
        return
    if duration is None:
        raise typer.BadParameter("needed: how long to walk, in seconds", param_hint="'--duration'")
    require_slip(model, slip)
    wanted = GaitRequest(
        name=gait.value,
        steering=steering,
        direction=None if direction is None else direction.value,
        touchdown_deg=touchdown_deg,
        liftoff_deg=liftoff_deg,
        cycle=cycle,
        tau_ground=tau_ground,
        tau_flight=tau_flight,
        tau_turn=tau_turn,
    )
    band = BandRequest(draws, seed, offset_sd_deg, start_sd, threads=threads) if draws else None
    request = WalkRequest(wanted, asked, duration, band)
    run_and_report(lambda watcher: run(request, watcher), asked)


def _write_robot(file: Path, asked: "ModelRequest") -> None:
    from zebro_lab.walk.stage import write_robot

    say(f"wrote {write_robot(file, asked)}")
