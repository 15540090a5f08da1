# SPDX-License-Identifier: MIT
"""Options of a track."""

import re
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from typer import Argument, BadParameter, Option

from zebro_lab.files.errors import SettingsError
from zebro_lab.files.units import option_to_si
from zebro_lab.robot.marker_print import LARGEST_PRINT
from zebro_lab.terminal.picture_options import FormatOption
from zebro_lab.terminal.request_command import Range

KIND = "track"
VIDEOS = (".mp4", ".mov", ".m4v", ".avi", ".mkv", ".webm")


def _moment(text: str) -> datetime:
    """Parse --start; the time, which has no zone on a camera's clock, is labelled UTC.

    Raises:
        BadParameter: The text is no ISO 8601 time, or has a time zone other than UTC.
    """
    try:
        moment = datetime.fromisoformat(text)
    except ValueError as error:
        raise BadParameter(
            f"'{text}' is not a time such as 2020-06-01T12:00:00", param_hint="'--start'"
        ) from error
    if moment.utcoffset():
        raise BadParameter(
            f"'{text}' has a time zone, which a camera's clock does not have; give the time as "
            f"that clock shows it, such as {moment:%Y-%m-%dT%H:%M:%S}, without a zone",
            param_hint="'--start'",
        )
    return moment.replace(tzinfo=UTC)


@dataclass(frozen=True)
class TimeRequest:
    """Options for the times of photographs; without any, EXIF times or a video's time stamps.

    Raises:
        SettingsError: Both an interval and a table are given.
    """

    interval: Annotated[
        float | None,
        Option(
            metavar="SECONDS",
            help="Interval of the camera's timer or of exposures, instead of EXIF times [s].",
        ),
        Range(above=0),
    ] = None
    table: Annotated[
        Path | None,
        Option(
            "--times",
            metavar="CSV",
            help="Table of times, with columns photo, t_s [s] and optionally t_sigma [s].",
        ),
    ] = None
    every: Annotated[
        float | None,
        Option(
            metavar="SECONDS",
            help="Least time between frames of a video [s]; default: 0.5; 0 takes all.",
        ),
        Range(least=0),
    ] = None
    clock: Annotated[
        Path | None, Option(metavar="PHOTO", help="Photograph of what `camera clock` shows.")
    ] = None

    def __post_init__(self) -> None:
        if self.interval is not None and self.table is not None:
            raise SettingsError("not together with --interval; give one of them", key="--times")

    @property
    def frame_step(self) -> float:
        """Least time between two frames of a video [s], by default 0.5; 0 takes all frames."""
        return 0.5 if self.every is None else self.every


@dataclass(frozen=True)
class TrackRequest:
    """Options of `zebro-lab track`.

    Raises:
        SettingsError: A length or the source has another form.
    """

    photos: Annotated[
        Path,
        Argument(
            metavar="PHOTOS",
            help="Folder of photographs, a video, or one picture into which exposures were pasted.",
        ),
    ]
    camera: Annotated[Path, Option(metavar="FILE", help="camera.toml, the lens.")]
    floor: Annotated[Path, Option(metavar="FILE", help="floor.toml, the marks on the floor.")]
    robot: Annotated[
        Path | None, Option(metavar="FILE", help="robot.toml; default: thesis's, no marker.")
    ] = None
    out: Annotated[
        Path | None, Option(metavar="DIR", help="Folder to write; default: RUN/track.")
    ] = None
    run: Annotated[Path | None, Option(metavar="RUN", help="Run of the photographed walk.")] = None
    times: TimeRequest = field(default_factory=TimeRequest)
    start: Annotated[
        datetime | None,
        Option(
            metavar="YYYY-MM-DDTHH:MM:SS",
            parser=_moment,
            help="Moment from which time is counted, as the camera's clock shows it; default: the "
            "run's start with --run and --clock, else the first photograph.",
        ),
    ] = None
    without_marker: Annotated[
        bool,
        Option("--without-marker", help="Track the robot by its top, annotated in one photograph."),
    ] = False
    annotations: Annotated[
        Path | None, Option(metavar="FILE", help="annotations.toml to apply.")
    ] = None
    body_height: Annotated[
        str | None,
        Option(
            metavar="LENGTH",
            help="Mean height of the body's centre over the walk; default: its height while the "
            "robot stands, by the marker's.",
        ),
    ] = None
    mean_height_sd: Annotated[
        str | None,
        Option(
            metavar="LENGTH",
            help="Standard deviation of that mean height; default: that of --height-sd.",
        ),
    ] = None
    height_sd: Annotated[
        str,
        Option(
            metavar="LENGTH",
            help="Standard deviation of the body's height about its mean, as it bounces.",
        ),
    ] = "5mm"
    gap: Annotated[
        float | None,
        Option(
            metavar="SECONDS",
            help="Longest time between two poses of an uninterrupted path [s]; default: 3.5 median "
            "intervals.",
        ),
        Range(above=0),
    ] = None
    source: Annotated[
        str | None,
        Option(
            metavar="real|sim:WHAT",
            help="Source of the photographs: real or sim:WHAT; default: that of the files or of "
            "the run.",
        ),
    ] = None
    form: FormatOption = "png"

    def __post_init__(self) -> None:
        _ = self.stated_height, self.stated_mean_height_sd, self.bounce_sd
        if self.source is not None and not re.fullmatch("real|sim:.+", self.source):
            raise SettingsError(f"found '{self.source}'; expected real or sim:WHAT", key="--source")

    @property
    def folder(self) -> Path:
        """The track folder to write: `out`, else `track` in the run folder.

        Raises:
            SettingsError: Neither a run nor a folder is named.
        """
        if self.out is not None:
            return self.out
        if self.run is None:
            raise SettingsError("missing: give --run RUN, to write RUN/track, or --out FOLDER")
        return self.run / KIND

    @property
    def stated_height(self) -> float | None:
        """Mean height of the body's centre [m]; None: the standing robot's, by its marker."""
        return None if self.body_height is None else _length(self.body_height, "--body-height")

    @property
    def stated_mean_height_sd(self) -> float:
        """Standard deviation of the mean height of the body's centre over the walk [m].

        As stated, else `bounce_sd`.
        """
        if self.mean_height_sd is None:
            return self.bounce_sd
        return _length(self.mean_height_sd, "--mean-height-sd")

    @property
    def bounce_sd(self) -> float:
        """Standard deviation of the height of the body's centre about its mean [m]."""
        return _length(self.height_sd, "--height-sd")

    @property
    def named(self) -> tuple[Path, ...]:
        """Input files named by options: camera, floor, robot, annotations, times, clock."""
        files = (self.camera, self.floor, self.robot, self.annotations,
                 self.times.table, self.times.clock)  # fmt: skip
        return tuple(file for file in files if file is not None)

    @property
    def inputs(self) -> tuple[Path, ...]:
        """All inputs named by options: photographs, files and run folder."""
        return (self.photos, *self.named, *((self.run,) if self.run is not None else ()))


def _length(text: str, key: str) -> float:
    """Convert an option's length to metres."""
    return option_to_si(text, "m", key=key, usual=LARGEST_PRINT)
