# SPDX-License-Identifier: MIT
"""Options of recordings, of the check of the legs, and of simulated devices."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeAlias

from typer import Argument, Option

_ADDRESS = "PROFILE@PORT|sim|replay:RUN"


@dataclass(frozen=True)
class RecordRequest:
    """Options of `zebro-lab record`."""

    label: Annotated[str, Option(help="Name of the run.")]
    data: Annotated[Path, Option(metavar="DIR", help="Folder of run folders.")]
    zebro: Annotated[str | None, Option(metavar=_ADDRESS, help="Robot whose legs to record.")] = (
        None
    )
    play: Annotated[
        Path | None,
        Option(metavar="FILE", help="Leg angles to send to the robot: path.csv or a leg log."),
    ] = None
    imus: Annotated[
        tuple[str, ...],
        Option("--imu", metavar=_ADDRESS, help="Inertial measurement unit to record; repeatable."),
    ] = ()
    rig: Annotated[str | None, Option(metavar=_ADDRESS, help="Slip rig to record.")] = None
    duration: Annotated[
        float | None,
        Option(
            help="Duration from the first samples [s]; default: until q, Ctrl-C or the end of the "
            "played gait or replayed run."
        ),
    ] = None
    material: Annotated[str, Option(help="Leg and ground material.")] = "unknown"
    operator: Annotated[str, Option(help="Name of the operator.")] = "unknown"
    robot: Annotated[str | None, Option(help="Name of the robot, for the record.")] = None
    seed: Annotated[int, Option(min=0, help="Seed of simulated devices.")] = 0


@dataclass(frozen=True)
class CheckRequest:
    """Options of `zebro-lab zebro check`."""

    address: Annotated[
        str, Argument(metavar="PROFILE@PORT", help="Robot; PROFILE@sim or sim is a twin.")
    ]
    save: Annotated[Path, Option(metavar="FILE", help="Profile to write.")] = Path("zebro.toml")
    touchdown_deg: Annotated[
        float | None,
        Option(
            "--lift-off-for",
            metavar="DEG",
            help="Also find the lift-off angle whose hip height is this touchdown's [deg].",
        ),
    ] = None


Profile: TypeAlias = Annotated[str, Argument()]
Can: TypeAlias = Annotated[
    str | None,
    Option(
        metavar="INTERFACE:CHANNEL",
        help="Bus for devices on CAN; default: a simulated adapter at a port, which speaks SLCAN.",
    ),
]
Socket: TypeAlias = Annotated[
    bool, Option("--socket", help="Listen on socket:// in place of a pseudo-terminal.")
]
Flip: TypeAlias = Annotated[float, Option(min=0.0, max=1.0, help="Probability that a bit flips.")]
Drop: TypeAlias = Annotated[
    float, Option(min=0.0, max=1.0, help="Probability that a frame is lost.")
]
Garbage: TypeAlias = Annotated[
    float, Option(min=0.0, max=1.0, help="Probability of garbage between frames.")
]
Seed: TypeAlias = Annotated[int, Option(min=0, help="Seed of all random numbers.")]


@dataclass(frozen=True)
class ZebroTwinRequest:
    """Options of `zebro-lab sim zebro`."""

    profile: Profile = "zebro-100-serial"
    play: Annotated[Path | None, Option(metavar="FILE", help="Leg angles to walk: path.csv.")] = (
        None
    )
    can: Can = None
    as_socket: Socket = False
    flip: Flip = 0.0
    drop: Drop = 0.0
    garbage: Garbage = 0.0
    jitter: Annotated[float, Option(min=0.0, help="Jitter of the sampling times (sd) [s].")] = 0.0
    pause: Annotated[
        float, Option(min=0.0, max=1.0, help="Probability of a pause before a leg's flight.")
    ] = 0.0
    seed: Seed = 0


@dataclass(frozen=True)
class ImuTwinRequest:
    """Options of `zebro-lab sim imu`."""

    profile: Profile = "imu-quaternion-serial"
    as_socket: Socket = False
    flip: Flip = 0.0
    drop: Drop = 0.0
    garbage: Garbage = 0.0
    seed: Seed = 0


@dataclass(frozen=True)
class RigTwinRequest:
    """Options of `zebro-lab sim rig`."""

    profile: Profile = "rig-board-serial"
    can: Can = None
    as_socket: Socket = False
    drop: Drop = 0.0
    seed: Seed = 0
