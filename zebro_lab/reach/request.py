# SPDX-License-Identifier: MIT
"""Options of `reach`."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from typer import BadParameter, Option

from model.routes.goal import Goal
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import Range
from zebro_lab.walk.request import (
    GroundOption,
    ModelRequest,
    RobotOption,
    SlipOption,
    StepOption,
)

_GOAL = "'--goal'"
_FARTHEST = 100.0  # m; a stride is a tenth of a metre


def parse_goal(text: str) -> Goal:
    """Parse `X,Y[,DEG]`: a place in metres and perhaps the heading there in degrees.

    Raises:
        BadParameter: The text has another form, or the place is over 100 m away, or is where the
            robot stands, without another heading.

    >>> parse_goal("1,-0.5")
    Goal(x=1.0, y=-0.5, heading=None)
    >>> round(parse_goal("0,1,90").heading, 4)
    1.5708
    """
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise BadParameter(
            f"'{text}' is not X,Y[,DEG]; expected metres ahead and to the left, and perhaps the "
            "heading there in degrees, such as 1,-0.5 or 1,0.5,90",
            param_hint=_GOAL,
        )
    far = math.hypot(*numbers[:2])
    if far > _FARTHEST:
        raise BadParameter(
            f"'{text}' is {far:g} m away; expected metres, at most {_FARTHEST:g} m away",
            param_hint=_GOAL,
        )
    heading = math.radians(numbers[2]) if len(numbers) == 3 else None
    if far == 0 and not heading:
        raise BadParameter(
            f"'{text}' is where the robot stands; expected a place elsewhere", param_hint=_GOAL
        )
    return Goal(numbers[0], numbers[1], heading)


@dataclass(frozen=True)
class SteppingRequest:
    """Options of the gait of all parts of a manoeuvre."""

    gait: Annotated[
        str,
        Option(
            metavar="NAME|GROUPS",
            help="Gait: tripod or tetrapod, or groups of legs in the order of their steps, such as "
            '"{1,4} < {2,5} < {3,6}".',
        ),
    ] = "tripod"
    cycle: Annotated[
        float | None,
        Option(
            metavar="SECONDS",
            help="Duration of a cycle before waiting [s], shared evenly by the groups; default: 2.",
        ),
        Range(least=0.1, most=1000.0),
    ] = None
    tau_ground: Annotated[
        float | None,
        Option(metavar="SECONDS", help="Least stance time [s], with --tau-flight; no --cycle."),
        Range(least=0.01, most=1000.0),
    ] = None
    tau_flight: Annotated[
        float | None,
        Option(metavar="SECONDS", help="Flight time [s], with --tau-ground; no --cycle."),
        Range(least=0.01, most=1000.0),
    ] = None
    tau_double: Annotated[
        float,
        Option(
            metavar="SECONDS", help="Time that a group and the next stand together [s]; default: 0."
        ),
        Range(least=0.0, most=1000.0),
    ] = 0.0
    touchdown_deg: Annotated[
        float,
        Option(metavar="DEG", help="Leg angle at touchdown of a whole stance, 90 down [deg]."),
        Range(least=3.2, below=180.0),
    ] = 50.0
    liftoff_deg: Annotated[
        float | None,
        Option(
            metavar="DEG",
            help="Leg angle at lift-off of a whole stance [deg]; default: of equal hip height.",
        ),
        Range(least=3.2, below=360.0),
    ] = None

    def __post_init__(self) -> None:
        """Raise `BadParameter` for a cycle beside times, or one time without the other."""
        times = (self.tau_ground, self.tau_flight)
        if (times[0] is None) != (times[1] is None):
            missing = "--tau-ground" if times[0] is None else "--tau-flight"
            raise BadParameter("missing: the other time is given", param_hint=f"'{missing}'")
        if self.cycle is not None and times[0] is not None:
            raise BadParameter(
                "given beside --tau-ground and --tau-flight; give either", param_hint="'--cycle'"
            )


@dataclass(frozen=True)
class ReachRequest:
    """Options of `zebro-lab reach`."""

    goal: Annotated[
        tuple[str, ...],
        Option(
            metavar="X,Y[,DEG]",
            help="Where to go: metres ahead and to the left of the robot, and perhaps the heading "
            "there [deg], positive to the left; may be repeated.",
        ),
    ] = ()
    slip: SlipOption = None
    stepping: SteppingRequest = field(default_factory=SteppingRequest)
    robot: RobotOption = None
    dt: StepOption = None
    ground: GroundOption = None
    form: FormatOption = "png"
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write.")] = Path("reach")

    def __post_init__(self) -> None:
        """Check goals and model.

        Raises:
            BadParameter: A goal has another form or is where the robot stands.
            SettingsError: As `ModelRequest`.
        """
        for text in self.goal:
            parse_goal(text)
        _ = self.model

    @property
    def model(self) -> ModelRequest:
        """The model "dynamics" with its options."""
        return ModelRequest(
            slip=self.slip, robot=self.robot, dt=self.dt,
            ground=self.ground,
        )  # fmt: skip
