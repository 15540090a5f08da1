# SPDX-License-Identifier: MIT
"""Options that describe a gait."""

from dataclasses import asdict, dataclass
from typing import Annotated, Final, Literal, TypeAlias

from typer import BadParameter, Option

from model.similar_name import nearest
from zebro_lab.terminal.request_command import Range

GAIT_NAMES: Final = ("tripod", "suriana", "maxplus", "tetrapod", "buehler")
"""Names of gaits; any other is given by its groups of legs."""
Side: TypeAlias = Literal["left", "right"]
_PAIR = "INNER[,OUTER]"
_STEERING = (
    "Stance angle of the outer legs by that of the inner legs, for tripod; default: 1, "
    " which is straight."
)
_OTHER_SIDE = "the side to turn to is --direction left or right"
_SIDE = "Side to turn to, for all gaits but buehler; default: left."
_TOUCHDOWN = (
    "Leg angle at touchdown, 0 ahead, 90 down [deg]; default: 50 for tripod and buehler, 45 for "
    "tetrapod, else 35. OUTER for tripod only; default: computed."
)
_LIFTOFF = (
    "Leg angle at lift-off, 0 ahead, 90 down [deg]; default: computed for tripod, 118 for buehler, "
    "135 for tetrapod, else 130. OUTER for tripod only."
)
_GAIT = (
    "Gait: tripod, suriana, maxplus, tetrapod or buehler, or groups of legs in the order of their "
    'steps, such as "{1,4} < {2,5} < {3,6}", which max-plus algebra schedules.'
)
_CYCLE = (
    "Duration of a cycle [s], for tripod and buehler (default: 2) and, before turning and waiting, "
    "tetrapod (default: 3)."
)
_GROUND = (
    "Stance time without --tau-turn, for suriana and buehler; shortest stance time, for scheduled "
    "gaits (maxplus, tetrapod, groups) [s]; default: 0.8, for buehler half a cycle, for tetrapod "
    "two thirds."
)
_FLIGHT = (
    "Flight time without --tau-turn, for suriana and scheduled gaits [s]; default: 0.8, for "
    "tetrapod a third of the cycle."
)
_TURN = (
    "Time added to stance of the inner and to flight of the outer legs, for suriana and scheduled "
    "gaits [s]; default: 0, which is straight."
)
_DOUBLE = "Time that a group and the next stand together, for scheduled gaits [s]; default: 0."


def gait_name(text: str) -> str:
    """Return the name of a gait, or its groups of legs, which are not parsed here.

    Raises:
        BadParameter: The text is neither a known name nor has a group in braces.

    >>> gait_name("tripod")
    'tripod'
    """
    if text not in GAIT_NAMES and "{" not in text:
        raise BadParameter(
            f"'{text}' is not a gait; {nearest(text, GAIT_NAMES)}, or groups of legs such as "
            '"{1,4} < {2,5} < {3,6}"'
        )
    return text


@dataclass(frozen=True)
class GaitRequest:
    """Parameters of a gait; None for the gait's default."""

    name: Annotated[str, Option("--gait", parser=gait_name, metavar="NAME|GROUPS", help=_GAIT)] = (
        "tripod"
    )
    steering: Annotated[
        float | None, Option(help=_STEERING), Range(above=0, advice=_OTHER_SIDE)
    ] = None
    direction: Annotated[Side | None, Option(help=_SIDE)] = None
    touchdown_deg: Annotated[str | None, Option(metavar=_PAIR, help=_TOUCHDOWN)] = None
    liftoff_deg: Annotated[str | None, Option(metavar=_PAIR, help=_LIFTOFF)] = None
    cycle: Annotated[float | None, Option(metavar="SECONDS", help=_CYCLE), Range(above=0)] = None
    tau_ground: Annotated[float | None, Option(metavar="SECONDS", help=_GROUND), Range(above=0)] = (
        None
    )
    tau_flight: Annotated[float | None, Option(metavar="SECONDS", help=_FLIGHT), Range(above=0)] = (
        None
    )
    tau_turn: Annotated[float | None, Option(metavar="SECONDS", help=_TURN), Range(least=0)] = None
    tau_double: Annotated[float | None, Option(metavar="SECONDS", help=_DOUBLE), Range(least=0)] = (
        None
    )

    def given(self) -> dict[str, object]:
        """Return the options that are not None by name, except the name of the gait."""
        return {k: v for k, v in asdict(self).items() if v is not None and k != "name"}

    @property
    def side(self) -> Side:
        """Side to turn to, "left" by default."""
        return self.direction or "left"
