# SPDX-License-Identifier: MIT
"""Track photographs and compare predictions with tracks, for notebooks."""

from datetime import UTC, datetime
from pathlib import Path

from zebro_lab.front.defaults import PathLike, Silent, kept_or_temporary, optional
from zebro_lab.track.file import TrackFile
from zebro_lab.track.file import read_track as read_track_file
from zebro_lab.track.request import TimeRequest, TrackRequest
from zebro_lab.track.stage import TrackResult, track
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import Validated, validate


def read_track(path: PathLike) -> TrackFile:
    """Read tracked poses and their covariance.

    Args:
        path: A table of poses, or the folder of a `track.csv`.

    Raises:
        ZebroLabError: A file is missing or cannot be used, or has fewer than three poses; names
            file, row and column if known.
    """
    return read_track_file(Path(path))


def track_photos(
    photos: PathLike,
    *,
    out: PathLike,
    camera: PathLike,
    floor: PathLike,
    robot: PathLike,
    times: PathLike | None = None,
    start: datetime | None = None,
    annotations: PathLike | None = None,
    without_marker: bool = False,
) -> TrackResult:
    """Track the robot in photographs, as `zebro-lab track` does.

    Args:
        photos: Folder of photographs, video, or one picture into which exposures were pasted.
        out: Track folder to write.
        camera: The `camera.toml`.
        floor: The `floor.toml`.
        robot: The `robot.toml`, with the marker's place and its height while the robot stands.
        times: CSV with columns `photo`, `t_s` and optionally `t_sigma` [s]; None for EXIF times or
            the time stamps of a video, not for a composite picture.
        start: Moment from which time is counted, as the camera's clock shows it, without a time
            zone or with UTC; None for the first photograph.
        annotations: File of annotations that a person made in the photographs; None for none.
        without_marker: Whether to track the robot by a template, annotated in one photograph.

    Raises:
        ZebroLabError: A file or an option cannot be used.
        TrackingError: The photographs do not give a track.
    """
    if start is not None and start.tzinfo is None:
        start = start.replace(tzinfo=UTC)
    request = TrackRequest(
        Path(photos), Path(camera), Path(floor), robot=Path(robot), out=Path(out),
        times=TimeRequest(table=optional(times)), start=start, annotations=optional(annotations),
        without_marker=without_marker,
    )  # fmt: skip
    return track(request, Silent(), workers=1)


def validate_walks(
    *walks: PathLike | tuple[PathLike, PathLike],
    out: PathLike | None = None,
    anchor: bool = True,
    time_offset: float | None = 0.0,
    seed: int = 1,
) -> Validated:
    """Compute errors of predictions against tracks, as `zebro-lab validate` does.

    Args:
        walks: Run folders with a prediction and a track, or pairs (prediction, track).
        out: Validation folder to write; None to keep no files.
        anchor: Whether each path starts from the first tracked pose, which is then not scored.
        time_offset: Clock offset added to the tracks' times; None to estimate it [s].
        seed: Seed of all random numbers.

    Raises:
        ZebroLabError: A file is missing or invalid, `out` cannot be replaced, the clock offset is
            not determined, or prediction and track do not overlap in time.
        ModelError: Errors of a path cannot be computed.
    """
    pairs = tuple(
        (Path(each[0]), Path(each[1])) if isinstance(each, tuple) else pairs_of_run(Path(each))
        for each in walks
    )
    with kept_or_temporary(out) as folder:
        request = ValidateRequest(
            predicted=tuple(predicted for predicted, _ in pairs),
            track=tuple(track for _, track in pairs),
            out=folder,
            anchor=anchor,
            time_offset=time_offset or 0.0,
            estimate_offset=time_offset is None,
            seed=seed,
        )
        return validate(request, Silent())
