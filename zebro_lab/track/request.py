# SPDX-License-Identifier: MIT
"""Options of a track."""

from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import typer

from zebro_lab.files.errors import SettingsError
from zebro_lab.files.units import quantity_to_si

MergedAs: TypeAlias = Literal["pasted", "darkest", "mean"]
KIND = "track"
VIDEOS = (".mp4", ".mov", ".m4v", ".avi", ".mkv", ".webm")


def _moment(text: str) -> datetime:
    try:
        moment = datetime.fromisoformat(text)
    except ValueError as error:
        raise typer.BadParameter(
            f"'{text}' is no time; expected one such as 2020-06-01T12:00:00",
            param_hint="'--start'",
        ) from error
    if moment.utcoffset():
        raise typer.BadParameter(
            f"'{text}' has a time zone, which the camera's clock does not tell; give the time as "
            f"that clock shows it, {moment:%Y-%m-%dT%H:%M:%S} or another, without a zone",
            param_hint="'--start'",
        )
    return moment.replace(tzinfo=UTC)


@dataclass(frozen=True)
class TimeRequest:
    """Where the times of photographs come from."""

    interval: Annotated[
        float | None, typer.Option(help="Interval of the timer, where there is no EXIF [s].")
    ] = None
    table: Annotated[
        Path | None,
        typer.Option("--times", metavar="CSV", help="Times: columns photo, t_s, maybe t_sigma."),
    ] = None
    every: Annotated[
        float | None,
        typer.Option(min=0.0, help="Time between a video's frames; 0.5, 0 takes all [s]."),
    ] = None
    clock: Annotated[
        Path | None, typer.Option(metavar="PHOTO", help="Photograph of `zebro-lab camera clock`.")
    ] = None

    def __post_init__(self) -> None:
        if self.interval is not None and self.table is not None:
            raise SettingsError("not together with --interval; give one of them", key="--times")

    @property
    def frame_step(self) -> float:
        """Least time between two frames of a video; 0 takes all [s]."""
        return 0.5 if self.every is None else self.every


@dataclass(frozen=True)
class TrackRequest:
    """Options of `zebro-lab track`."""

    photos: Annotated[
        Path, typer.Argument(help="Folder of photographs, a video, or one composite picture.")
    ]
    camera: Annotated[Path, typer.Option("--camera", help="camera.toml.")]
    floor: Annotated[Path, typer.Option("--floor", help="floor.toml.")]
    robot: Annotated[
        Path | None, typer.Option("--robot", help="robot.toml; the thesis's robot without it.")
    ] = None
    out: Annotated[Path | None, typer.Option(help="Folder to write; RUN/track without it.")] = None
    run: Annotated[Path | None, typer.Option(metavar="RUN", help="Run folder they belong to.")] = (
        None
    )
    times: TimeRequest = field(default_factory=TimeRequest)
    start: Annotated[
        datetime | None,
        typer.Option(
            metavar="TIME",
            parser=_moment,
            help="Moment to count time from, as the camera shows it.",
        ),
    ] = None
    marker: Annotated[
        str | None,
        typer.Option(
            metavar="DICTIONARY:NUMBER:SIDE",
            help="What is printed on the robot, as in 4x4_50:0:120mm; robot.toml's without it.",
        ),
    ] = None
    without_marker: Annotated[
        bool,
        typer.Option("--without-marker", help="Track the robot by its own annotated picture."),
    ] = False
    merged: Annotated[
        MergedAs | None,
        typer.Option("--merged", help="How one composite picture was made of its exposures."),
    ] = None
    annotations: Annotated[
        Path | None, typer.Option("--annotations", help="What `zebro-lab annotate` wrote.")
    ] = None
    body_height: Annotated[
        str | None,
        typer.Option(
            metavar="LENGTH", help="Height of the body's centre; the marker's without it."
        ),
    ] = None
    height_sd: Annotated[
        str, typer.Option("--height-sd", metavar="LENGTH", help="How far a walk strays from it.")
    ] = "5mm"
    gap: Annotated[
        float | None, typer.Option(help="Pause that interrupts the path; 3.5 usual ones [s].")
    ] = None
    source: Annotated[
        str | None, typer.Option(help="real, or sim:WHAT; the files' or the run's without it.")
    ] = None
    workers: Annotated[int, typer.Option(min=1, help="Processes to use.")] = 2

    def __post_init__(self) -> None:
        is_picture = self.photos.is_file() and self.photos.suffix.lower() not in VIDEOS
        if self.merged is not None and self.photos.exists() and not is_picture:
            raise SettingsError("only with one composite picture", key="--merged")

    @property
    def folder(self) -> Path:
        """The track folder to write.

        Raises:
            SettingsError: Neither a run nor a folder is named.
        """
        if self.out is not None:
            return self.out
        if self.run is None:
            raise SettingsError("needed: --run RUN, to write RUN/track, or --out FOLDER")
        return self.run / KIND

    @property
    def standing_height(self) -> float | None:
        """Height of the body's centre while the robot stands; None for the marker's [m]."""
        return None if self.body_height is None else quantity_to_si(self.body_height, "m")

    @property
    def walking_height_sd(self) -> float:
        """Standard deviation of that height over a walk [m]."""
        return quantity_to_si(self.height_sd, "m")

    @property
    def named(self) -> tuple[Path, ...]:
        """Input files given, other than the photographs."""
        files = (self.camera, self.floor, self.robot, self.annotations,
                 self.times.table, self.times.clock)  # fmt: skip
        return tuple(file for file in files if file is not None)

    @property
    def inputs(self) -> tuple[Path, ...]:
        """All inputs given: photographs, files and run."""
        return (self.photos, *self.named, *((self.run,) if self.run is not None else ()))
