# SPDX-License-Identifier: MIT
"""Options of recordings, of the check of the legs, and of simulated devices."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeAlias

from typer import Argument, Option

from rig.errors import ProfileError
from rig.profile import split_address
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.request_command import Range

_REPLAY = "replay:"


def require_address(address: str, *, key: str, replay: bool = False) -> None:
    """Check that an address is PROFILE@PORT or `sim`; the profile is not looked up.

    Args:
        address: The address, as given.
        key: The option, for the error.
        replay: Whether `replay:RUN` is an address as well.

    Raises:
        SettingsError: The address has another form.
    """
    is_replay = replay and address.startswith(_REPLAY) and address != _REPLAY
    if address == "sim" or is_replay:
        return
    try:
        split_address(address)
    except ProfileError as error:
        others = "sim or replay:RUN" if replay else "sim"
        raise SettingsError(f"{error}, or {others}", key=key) from error


_ADDRESS = "PROFILE@PORT|sim|replay:RUN"
_DURATION = (
    "Longest duration, from when every device has sent a sample [s]; q, Ctrl-C and "
    "the end of --play or of the longest replayed run end it earlier; default: no limit."
)
_FOR = (
    "Also find the lift-off angle with the hip height of this touchdown angle; "
    "0 is ahead, 90 down [deg]."
)


@dataclass(frozen=True)
class RecordRequest:
    """Options of `zebro-lab record`."""

    label: Annotated[str, Option(help="Name of the run, part of its folder's name.")]
    data: Annotated[Path, Option(metavar="DIR", help="Folder in which to create the run folder.")]
    zebro: Annotated[
        str | None, Option(metavar=_ADDRESS, help="Robot whose leg angles to record.")
    ] = None
    play: Annotated[
        Path | None,
        Option(metavar="FILE", help="Leg angles to walk: a walk folder, table or recorded run."),
    ] = None
    imus: Annotated[
        tuple[str, ...],
        Option("--imu", metavar=_ADDRESS, help="Inertial measurement unit to record; repeatable."),
    ] = ()
    rig: Annotated[str | None, Option(metavar=_ADDRESS, help="Slip rig to record.")] = None
    duration: Annotated[float | None, Option(metavar="SECONDS", help=_DURATION), Range(above=0)] = (
        None
    )
    material: Annotated[str, Option(help="Leg and ground material.")] = "unknown"
    operator: Annotated[str, Option(help="Name of the operator.")] = "unknown"
    robot: Annotated[str | None, Option(help="Name of the robot, noted in run.json.")] = None
    seed: Annotated[
        int | None,
        Option(
            help="Seed of the random numbers of simulated devices; default: a new one for each "
            "run, noted in run.json.",
        ),
        Range(least=0),
    ] = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` for an address of another form."""
        addresses = {"--zebro": (self.zebro,), "--imu": self.imus, "--rig": (self.rig,)}
        for key, given in addresses.items():
            for address in given:
                if address is not None:
                    require_address(address, key=key, replay=True)


@dataclass(frozen=True)
class CheckRequest:
    """Options of `zebro-lab zebro check`."""

    address: Annotated[
        str, Argument(metavar="PROFILE@PORT", help="Robot; PROFILE@sim or sim to simulate one.")
    ]
    save: Annotated[Path, Option(metavar="FILE", help="New profile to write.")] = Path("zebro.toml")
    touchdown_deg: Annotated[
        float | None,
        Option("--lift-off-for", metavar="DEG", help=_FOR),
        Range(above=0, below=90),
    ] = None


Profile: TypeAlias = Annotated[
    str, Argument(metavar="PROFILE", help="Name of a shipped profile, or a profile file.")
]
Socket: TypeAlias = Annotated[
    bool, Option("--socket", help="Listen at a TCP port (socket://) instead of a pseudo-terminal.")
]
Drop: TypeAlias = Annotated[
    float, Option(help="Probability that a frame is lost."), Range(least=0, most=1)
]


@dataclass(frozen=True)
class ZebroTwinRequest:
    """Options of `zebro-lab sim zebro`."""

    profile: Profile = "zebro-100-serial"
    play: Annotated[
        Path | None, Option(metavar="FILE", help="Leg angles to walk: walk folder, table or run.")
    ] = None
    as_socket: Socket = False
    drop: Drop = 0.0


@dataclass(frozen=True)
class ImuTwinRequest:
    """Options of `zebro-lab sim imu`."""

    profile: Profile = "imu-quaternion-serial"
    play: Annotated[
        Path | None,
        Option(
            metavar="FILE",
            help="Leg angles of the robot that carries the unit: walk folder, table or run.",
        ),
    ] = None
    as_socket: Socket = False
    drop: Drop = 0.0


@dataclass(frozen=True)
class RigTwinRequest:
    """Options of `zebro-lab sim rig`."""

    profile: Profile = "rig-board-serial"
    as_socket: Socket = False
    drop: Drop = 0.0
