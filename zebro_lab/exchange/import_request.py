# SPDX-License-Identifier: MIT
"""Options of an import."""

from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Final

from typer import BadParameter, Option

from zebro_lab.files.errors import SettingsError
from zebro_lab.files.units import option_to_si
from zebro_lab.terminal.leg_options import JOINTS, TOPIC, joint_names
from zebro_lab.track.trajectory.request import TrajectoryRequest

_START = (
    "Date, time and time zone at which the files' time is 0, such as 2026-03-04T05:06:07+00:00; "
    "default: 1970 for times of 1e9 s and more, else now."
)
FIRST: Final = datetime(1970, 1, 1, tzinfo=UTC)
LARGEST_SD: Final = 0.5
"""Largest standard deviation of tracked positions [m]."""
LARGEST_SD_YAW: Final = 1.0
"""Largest standard deviation of tracked headings [rad]."""
LAST: Final = datetime(2038, 1, 19, tzinfo=UTC)
"""Day before which a run must end: the ROS stamps of a log hold seconds since 1970 in 32 bits."""


def _moment(text: str) -> datetime:
    """Parse the date of `--start` in ISO 8601, with or without a time zone, or `BadParameter`."""
    try:
        return datetime.fromisoformat(text)
    except ValueError as error:
        message = f"found '{text}'; expected date and time like 2026-03-04T05:06:07+00:00"
        raise BadParameter(message, param_hint="--start") from error


@dataclass(frozen=True)
class ImportRequest:
    """Options of `zebro-lab import`; `start` has a time zone, and lies from `FIRST` to `LAST`."""

    data: Annotated[Path, Option(metavar="DIR", help="Folder in which to create run folders.")]
    legs: Annotated[
        Path | None,
        Option(metavar="FILE", help="Leg angles: a table, or a ROS log (MCAP, db3, bag)."),
    ] = None
    track: Annotated[
        Path | None,
        Option(
            metavar="FILE",
            help="The robot's path: a table, TUM, KITTI, EuRoC, a ROS log; alone or with --legs.",
        ),
    ] = None
    imu: Annotated[
        Path | None, Option(metavar="FILE", help="Orientation of the body: a table or a ROS log.")
    ] = None
    robot: Annotated[Path | None, Option(metavar="FILE", help="robot.toml to copy to the run.")] = (
        None
    )
    columns: Annotated[
        Path | None, Option(metavar="FILE", help="columns.toml instead of those beside the files.")
    ] = None
    joints: Annotated[str | None, Option(metavar="A,B,C,D,E,F", help=JOINTS)] = None
    topic: Annotated[tuple[str, ...], Option(metavar="NAME", help=TOPIC)] = ()
    label: Annotated[str | None, Option(help="Name of the run; default: name of the file.")] = None
    start: Annotated[datetime | None, Option(metavar="TIME", parser=_moment, help=_START)] = None
    track_offset: Annotated[
        float,
        Option(
            metavar="SECONDS",
            help="Time by which the track's clock is behind that of the legs, added to its times "
            "[s]; validate RUN --estimate-offset finds what is left.",
        ),
    ] = 0.0
    track_sd: Annotated[
        str | None,
        Option(
            metavar="LENGTH",
            help="Standard deviation of x and of y of each tracked pose, such as '1 mm', where the "
            "file has none; a fit of walks (calibrate-slip --walks) needs it.",
        ),
    ] = None
    track_sd_yaw: Annotated[
        str | None,
        Option(
            metavar="ANGLE",
            help="Standard deviation of the heading of each tracked pose, such as '0.2 deg'.",
        ),
    ] = None
    material: Annotated[str, Option(help="Leg and ground material.")] = "unknown"
    operator: Annotated[str, Option(help="Name of the person who recorded.")] = "unknown"
    trajectory: TrajectoryRequest = field(default_factory=TrajectoryRequest)

    def __post_init__(self) -> None:
        """Raise `SettingsError` for a wrong `--start`, `--joints` or standard deviation."""
        joint_names(self.joints)
        _ = self.pose_sd
        if self.start is not None:
            _require_start(self.start)

    @property
    def pose_sd(self) -> tuple[float, float | None] | None:
        """Standard deviations of tracked positions [m] and headings [rad]; None if none is given.

        That of the headings is None if only that of the positions is given.

        Raises:
            SettingsError: One is no length or angle, not above 0, or implausibly large; or that of
                the heading stands alone.
        """
        given = ((self.track_sd, "m", LARGEST_SD, "--track-sd"),
                 (self.track_sd_yaw, "rad", LARGEST_SD_YAW, "--track-sd-yaw"))  # fmt: skip
        position, yaw = (
            None if text is None else _sd(text, unit, most=most, key=key)
            for text, unit, most, key in given
        )
        if position is None and yaw is not None:
            raise SettingsError("needs that of the position, too", key="--track-sd")
        return None if position is None else (position, yaw)


def _sd(text: str, si_unit: str, *, most: float, key: str) -> float:
    """Convert a standard deviation to SI; `SettingsError` unless above 0 and at most `most`."""
    found = option_to_si(text, si_unit, key=key)
    if not 0 < found <= most:
        raise SettingsError(f"found {text}; expected above 0, at most {most:g} {si_unit}", key=key)
    return found


def _require_start(start: datetime) -> None:
    """Raise `SettingsError` if a start has no time zone or is not from `FIRST` to `LAST`."""
    if start.tzinfo is None:
        raise SettingsError(
            f"{start.isoformat()} has no time zone; append it, such as +00:00 for UTC or +01:00",
            key="--start",
        )
    if not FIRST <= start < LAST:
        raise SettingsError(
            f"found {start.isoformat()}; expected a time from 1970 to {LAST:%Y-%m-%d}, since the "
            "ROS stamps of a log hold seconds in 32 bits",
            key="--start",
        )
