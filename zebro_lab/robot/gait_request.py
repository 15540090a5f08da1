# SPDX-License-Identifier: MIT
"""Options that describe a gait."""

from dataclasses import asdict, dataclass
from typing import Annotated, Literal, TypeAlias

import typer

GaitName: TypeAlias = Literal["tripod", "suriana", "maxplus", "tetrapod", "buehler"]
Side: TypeAlias = Literal["left", "right"]
_PAIR = "INNER[,OUTER]"


@dataclass(frozen=True)
class GaitRequest:
    """Parameters of a gait; None for the gait's default."""

    name: Annotated[GaitName, typer.Option("--gait", help="How the legs take turns.")] = "tripod"
    steering: Annotated[
        float | None,
        typer.Option(help="Outer over inner stance angle of the tripod; 1 is straight."),
    ] = None
    direction: Annotated[
        Side | None, typer.Option(help="Where to turn, for tripod, suriana, maxplus.")
    ] = None
    touchdown_deg: Annotated[
        str | None, typer.Option(metavar=_PAIR, help="Leg angle at touchdown [deg].")
    ] = None
    liftoff_deg: Annotated[
        str | None,
        typer.Option(metavar=_PAIR, help="Leg angle at lift-off; the tripod's is computed [deg]."),
    ] = None
    cycle: Annotated[float | None, typer.Option(help="Cycle of tripod, tetrapod, buehler [s].")] = (
        None
    )
    tau_ground: Annotated[
        float | None, typer.Option(help="Time on the ground, for suriana, maxplus, buehler [s].")
    ] = None
    tau_flight: Annotated[
        float | None, typer.Option(help="Time in flight, suriana, maxplus [s].")
    ] = None
    tau_turn: Annotated[
        float | None,
        typer.Option(help="How much longer inner legs stand, suriana, maxplus [s]."),
    ] = None

    def given(self) -> dict[str, object]:
        """Return the options that were given, by name, without the name of the gait."""
        return {k: v for k, v in asdict(self).items() if v is not None and k != "name"}

    @property
    def side(self) -> Side:
        """Side to turn to."""
        return self.direction or "left"
