# SPDX-License-Identifier: MIT
"""Options of experiments of the slip rig."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, TypeAlias

from typer import Argument, BadParameter, Option

STANDARD_GRAVITY: Final = 9.80665

Rig: TypeAlias = Annotated[str, Option(help="PROFILE@PORT, PROFILE@sim, or sim.")]
Data: TypeAlias = Annotated[Path, Option(metavar="DIR", help="Folder of the experiment.")]
Fast: TypeAlias = Annotated[
    bool, Option("--fast", help="Run a simulated rig faster than real time.")
]
Seed: TypeAlias = Annotated[
    int, Option(help="Seed of a simulated rig: its load cell, noise and slip wander.")
]


def _masses(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(mass) for mass in text.split(","))
    except ValueError as error:
        raise BadParameter(f"found '{text}'; expected 0.2,0.5,1") from error


@dataclass(frozen=True)
class RigRunRequest:
    """Options of `zebro-lab rig run`."""

    plan: Annotated[Path, Argument(metavar="PLAN", help="A plan.toml.")]
    rig: Rig
    data: Data = Path("experiment")
    resume: Annotated[bool, Option("--resume", help="Continue after the last finished point.")] = (
        False
    )
    reset_emergency: Annotated[
        bool, Option("--reset-emergency", help="Reset a latched emergency stop.")
    ] = False
    fast: Fast = False
    seed: Seed = 0


@dataclass(frozen=True)
class WeighRequest:
    """Options of `zebro-lab rig weigh`."""

    rig: Rig
    masses: Annotated[
        Sequence[float], Option(metavar="KG,KG…", parser=_masses, help="Known masses [kg].")
    ]
    data: Annotated[
        Path | None, Option(metavar="DIR", help="Write DIR/columns.toml for the fit.")
    ] = None
    weight_sd: Annotated[
        float, Option(min=0.0, help="Relative error that all masses share [-].")
    ] = 1e-3
    gravity: Annotated[float, Option(help="Gravity at the rig [m/s2].")] = STANDARD_GRAVITY
    fast: Fast = False
    seed: Seed = 0
