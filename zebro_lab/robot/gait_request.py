# SPDX-License-Identifier: MIT
"""Options that describe a gait."""

from dataclasses import asdict, dataclass
from typing import Annotated, Literal, TypeAlias

from typer import Option

from zebro_lab.terminal.limits import Limits

GaitName: TypeAlias = Literal["tripod", "suriana", "maxplus", "tetrapod", "buehler"]
Side: TypeAlias = Literal["left", "right"]
_PAIR = "INNER[,OUTER]"
_STEERING = (
    "Stance angle of the outer legs by that of the inner legs, for tripod; default: 1, "
    " which is straight."
)
_OTHER_SIDE = "the side to turn to is --direction left or right"
_SIDE = "Side to turn to, for tripod, suriana and maxplus; default: left."
_TOUCHDOWN = (
    "Leg angle at touchdown, 0 ahead, 90 down [deg]; default: 50 for tripod and buehler, 45 for "
    "tetrapod, else 35. OUTER for tripod only; default: computed."
)
_LIFTOFF = (
    "Leg angle at lift-off, 0 ahead, 90 down [deg]; default: computed for tripod, 118 for buehler, "
    "135 for tetrapod, else 130. OUTER for tripod only."
)
_CYCLE = "Duration of a cycle [s], for tripod and buehler (default: 2) and tetrapod (default: 3)."
_GROUND = (
    "Stance time without --tau-turn, for suriana and buehler; shortest stance time, for maxplus "
    "[s]; default: 0.8, for buehler half a cycle."
)
_FLIGHT = "Flight time without --tau-turn, for suriana and maxplus [s]; default: 0.8."
_TURN = (
    "Time added to stance of the inner and to flight of the outer legs, for suriana and maxplus "
    "[s]; default: 0, which is straight."
)


@dataclass(frozen=True)
class GaitRequest:
    """Parameters of a gait; None for the gait's default."""

    name: Annotated[GaitName, Option("--gait", help="Gait: pattern of leg motion.")] = "tripod"
    steering: Annotated[
        float | None, Option(help=_STEERING), Limits(above=0, advice=_OTHER_SIDE)
    ] = None
    direction: Annotated[Side | None, Option(help=_SIDE)] = None
    touchdown_deg: Annotated[str | None, Option(metavar=_PAIR, help=_TOUCHDOWN)] = None
    liftoff_deg: Annotated[str | None, Option(metavar=_PAIR, help=_LIFTOFF)] = None
    cycle: Annotated[float | None, Option(metavar="SECONDS", help=_CYCLE), Limits(above=0)] = None
    tau_ground: Annotated[
        float | None, Option(metavar="SECONDS", help=_GROUND), Limits(above=0)
    ] = None
    tau_flight: Annotated[
        float | None, Option(metavar="SECONDS", help=_FLIGHT), Limits(above=0)
    ] = None
    tau_turn: Annotated[float | None, Option(min=0.0, metavar="SECONDS", help=_TURN)] = None

    def given(self) -> dict[str, object]:
        """Return the options that are not None by name, except the name of the gait."""
        return {k: v for k, v in asdict(self).items() if v is not None and k != "name"}

    @property
    def side(self) -> Side:
        """Side to turn to, "left" by default."""
        return self.direction or "left"
