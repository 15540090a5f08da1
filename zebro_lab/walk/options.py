# SPDX-License-Identifier: MIT
"""Command-line options that `walk` and `predict` share."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class Model(StrEnum):
    """The walking models."""

    DYNAMICS = "dynamics"
    THESIS = "thesis"
    NO_SLIP = "no-slip"
    NO_SLIP_SIMPLE = "no-slip-simple"


class Toe(StrEnum):
    """Traction laws of a leg on its toe, which no rig has measured."""

    SATURATED = "saturated"
    PEAK = "peak"
    BRISTLE = "bristle"


class Direction(StrEnum):
    """Sides to turn to."""

    LEFT = "left"
    RIGHT = "right"


Out = Annotated[Path, typer.Option(help="Walk folder to write.")]
Slip = Annotated[
    str | None,
    typer.Option(
        help="How legs slip: a slip.toml, its folder, coulomb:MU[:V] (V in m/s) or thesis. "
        "Needed by the models that slip.",
        metavar="SLIP",
    ),
]
ModelName = Annotated[
    Model,
    typer.Option(
        help="dynamics: ours; thesis: the thesis's, with its faults; no-slip: exact kinematics; "
        "no-slip-simple: wheels."
    ),
]
ToeName = Annotated[
    Toe, typer.Option(help="Traction of a leg on its toe, for dynamics: no rig measures it.")
]
RobotFile = Annotated[
    Path | None, typer.Option("--robot", help="robot.toml; the thesis's robot without it.")
]
ArcDeg = Annotated[
    float | None, typer.Option(help="Arc of the legs, 180 to 200, in place of the robot's [deg].")
]
StepLength = Annotated[
    float | None, typer.Option("--dt", min=0.0, help="Length of a step; the model's own [s].")
]
Figures = Annotated[bool, typer.Option("--figures", help="Draw path, motion, forces, contacts.")]
Draws = Annotated[
    int,
    typer.Option(
        min=0, help="Paths drawn for the band: draws.npz, band.csv, band.png; 0 for none."
    ),
]
Seed = Annotated[int, typer.Option(help="Seed of the band's draws.")]
OffsetSdDeg = Annotated[
    float | None,
    typer.Option(
        min=0.0, help="Unknown offset of each leg (sd) [deg]; that of a count, or 0.3, without it."
    ),
]
StartSd = Annotated[
    tuple[float, float, float],
    typer.Option(help="Start pose's sd: x y [m] yaw [deg].", metavar="X Y YAW"),
]
Threads = Annotated[int, typer.Option(min=1, help="Draws walked at once.")]
Animate = Annotated[bool, typer.Option("--animate", help="Film the robot: mp4, or gif.")]


def require_slip(model: Model, slip: str | None) -> None:
    """Check that `--slip` is given if the model needs it.

    Args:
        model: Chosen model.
        slip: Value of `--slip`; None if it was not given.

    Raises:
        BadParameter: The model has slipping legs and `--slip` is missing.
    """
    if slip is None and model in (Model.DYNAMICS, Model.THESIS):
        raise typer.BadParameter(
            f"needed: legs slip in the model '{model.value}'; name a slip.toml, the folder that "
            "holds it, coulomb:MU[:V] or thesis",
            param_hint="'--slip'",
        )
