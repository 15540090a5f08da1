# SPDX-License-Identifier: MIT
"""Options of experiments of the slip rig."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, TypeAlias

from typer import Argument, BadParameter, Option

from zebro_lab.recording.request import require_address
from zebro_lab.terminal.request_command import Range

STANDARD_GRAVITY: Final = 9.80665

Rig: TypeAlias = Annotated[
    str, Option(metavar="PROFILE@PORT", help="Rig; PROFILE@sim or sim to simulate one.")
]
Data: TypeAlias = Annotated[Path, Option(metavar="DIR", help="Folder of the experiment.")]
Fast: TypeAlias = Annotated[
    bool, Option("--fast", help="Run a simulated rig with a board faster than real time.")
]
Seed: TypeAlias = Annotated[
    int,
    Option(help="Which simulated rig: errors of its load cell; noise is new in each run."),
    Range(least=0),
]


def _masses(text: str) -> tuple[float, ...]:
    """Parse --masses: numbers above 0, separated by commas [kg]; else raise `BadParameter`."""
    try:
        masses = tuple(float(mass) for mass in text.split(","))
    except ValueError:
        masses = ()
    if not masses or not all(0 < mass < math.inf for mass in masses):
        raise BadParameter(f"found '{text}'; expected masses in kg, above 0, like 0.2,0.5,1")
    return masses


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
    no_watchdog_proof: Annotated[
        bool, Option("--no-watchdog-proof", help="Do not try the drives' watchdogs before motion.")
    ] = False
    fast: Fast = False
    seed: Seed = 0

    def __post_init__(self) -> None:
        """Raise `SettingsError` for an address of another form."""
        require_address(self.rig, key="--rig")


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
    gravity: Annotated[
        float, Option(help="Gravity at the rig [m/s²]."), Range(above=0.0, most=30.0)
    ] = STANDARD_GRAVITY
    fast: Fast = False
    seed: Seed = 0

    def __post_init__(self) -> None:
        """Raise `SettingsError` for an address of another form."""
        require_address(self.rig, key="--rig")
