# SPDX-License-Identifier: MIT
"""Options of a track."""

from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from tracking.composite import Merged
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.folder import KIND
from zebro_lab.track.photo_sequence import VIDEOS, TimeRequest
from zebro_lab.track.robot import WALKING_HEIGHT_SD


@dataclass(frozen=True)
class TrackRequest:
    """Options of a track: photographs, files and settings.

    Attributes:
        photos: Folder of photographs, video, or one composite picture.
        camera: The `camera.toml`.
        floor: The `floor.toml`.
        robot: The `robot.toml`; the thesis's robot when None.
        out: Folder to write; None for the run's own `track/`.
        run: Run folder the photographs belong to.
        times: How the photographs get their times.
        start: Moment from which time is counted; None for the run's start or the first photograph.
        marker: The robot's marker: dictionary, number and side; None to take that of the robot's
            file.
        without_marker: Track the robot by a template, annotated in one photograph.
        merged: How the exposures of a composite picture were merged; None for other photographs.
        annotations: An `annotations.toml`, a person's annotations of the photographs.
        body_height: Height of the body's origin while the robot stands; None to take the marker's
            [m].
        height_sd: Standard deviation of that height over a walk [m].
        gap: Interval longer than which the path is interrupted; None for 3.5 usual ones [s].
        source: Source of the photographs; None to take that of the files or of the run.
        workers: Processes to use.
    """

    photos: Path
    camera: Path
    floor: Path
    robot: Path | None = None
    out: Path | None = None
    run: Path | None = None
    times: TimeRequest = field(default_factory=TimeRequest)
    start: datetime | None = None
    marker: str | None = None
    without_marker: bool = False
    merged: Merged | None = None
    annotations: Path | None = None
    body_height: float | None = None
    height_sd: float = WALKING_HEIGHT_SD
    gap: float | None = None
    source: str | None = None
    workers: int = 1

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
    def named(self) -> tuple[Path, ...]:
        """Input files given, other than the photographs."""
        files = (self.camera, self.floor, self.robot, self.annotations,
                 self.times.table, self.times.clock)  # fmt: skip
        return tuple(file for file in files if file is not None)

    @property
    def inputs(self) -> tuple[Path, ...]:
        """All inputs given: photographs, files and run."""
        return (self.photos, *self.named, *((self.run,) if self.run is not None else ()))
