# SPDX-License-Identifier: MIT
"""Options of experiments of the slip rig."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, TypeAlias

from typer import Argument, BadParameter, Option

STANDARD_GRAVITY: Final = 9.80665

Rig: TypeAlias = Annotated[str, Option(help="PROFILE@PORT or PROFILE@sim; sim: rig-board-serial")]
Data: TypeAlias = Annotated[Path, Option(metavar="DIR", help="Folder of the experiment.")]
Fast: TypeAlias = Annotated[
    bool, Option("--fast", help="Run a simulated rig with a board faster than real time.")
]
Seed: TypeAlias = Annotated[
    int, Option(help="Seed of a simulated rig: load cell errors, noise, slip wander.")
]


def _masses(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(mass) for mass in text.split(","))
    except ValueError as error:
        raise BadParameter(f"found '{text}'; expected masses in kg like 0.2,0.5,1") from error


@dataclass(frozen=True)
class RigRunRequest:
    """Options of `zebro-lab rig run`."""

    plan: Annotated[Path, Argument(metavar="PLAN", help="Plan file (TOML).")]
    rig: Rig
    data: Data = Path("experiment")
    resume: Annotated[bool, Option("--resume", help="Measure the points still missing in DIR.")] = (
        False
    )
    reset_emergency: Annotated[
        bool, Option("--reset-emergency", help="Reset the emergency stop latched in DIR.")
    ] = False
    fast: Fast = False
    seed: Seed = 0


@dataclass(frozen=True)
class WeighRequest:
    """Options of `zebro-lab rig weigh`."""

    rig: Rig
    masses: Annotated[
        Sequence[float],
        Option(metavar="KG,KG…", parser=_masses, help="Known masses to hang, in order [kg]."),
    ]
    data: Annotated[
        Path | None, Option(metavar="DIR", help="Folder for columns.toml with gain_sd and bias_sd.")
    ] = None
    weight_sd: Annotated[
        float, Option(min=0.0, help="Sd of the relative error common to all masses [-].")
    ] = 1e-3
    gravity: Annotated[float, Option(help="Gravity at the rig [m/s²].")] = STANDARD_GRAVITY
    fast: Fast = False
    seed: Seed = 0
