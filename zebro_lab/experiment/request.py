# SPDX-License-Identifier: MIT
"""Options of experiments of the slip rig."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, TypeAlias

import typer

STANDARD_GRAVITY: Final = 9.80665

Rig: TypeAlias = Annotated[str, typer.Option(help="PROFILE@PORT, PROFILE@sim, or sim.")]
Data: TypeAlias = Annotated[Path, typer.Option(metavar="DIR", help="Folder of the experiment.")]
Fast: TypeAlias = Annotated[
    bool, typer.Option("--fast", help="Let a simulated rig's time pass at once.")
]
Seed: TypeAlias = Annotated[
    int, typer.Option(help="Of a simulated rig: its load cell, noise and wander.")
]


def _masses(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(mass) for mass in text.split(","))
    except ValueError as error:
        raise typer.BadParameter(f"found '{text}'; expected 0.2,0.5,1") from error


@dataclass(frozen=True)
class RigRunRequest:
    """Options of `zebro-lab rig run`."""

    plan: Annotated[Path, typer.Argument(metavar="PLAN", help="A plan.toml.")]
    rig: Rig
    data: Data = Path("experiment")
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the last finished point.")
    ] = False
    reset_emergency: Annotated[
        bool, typer.Option("--reset-emergency", help="Reset a latched emergency stop.")
    ] = False
    fast: Fast = False
    seed: Seed = 0


@dataclass(frozen=True)
class WeighRequest:
    """Options of `zebro-lab rig weigh`."""

    rig: Rig
    masses: Annotated[
        Sequence[float],
        typer.Option(metavar="KG,KG…", parser=_masses, help="Known masses [kg]."),
    ]
    data: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write DIR/columns.toml for the fit.")
    ] = None
    weight_sd: Annotated[
        float, typer.Option(min=0.0, help="Relative error that the masses share.")
    ] = 1e-3
    gravity: Annotated[float, typer.Option(help="Where the rig stands [m/s2].")] = STANDARD_GRAVITY
    fast: Fast = False
    seed: Seed = 0
