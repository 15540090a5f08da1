# SPDX-License-Identifier: MIT
"""`zebro-lab track`: the path of a robot from photographs."""

import sys
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.terminal.messages import say

if TYPE_CHECKING:
    from zebro_lab.track.preview_stage import Preview
    from zebro_lab.track.request import TrackRequest
    from zebro_lab.track.stage import TrackResult

INTERRUPTED = 130
_MOST_LISTED = 10

EPILOG = """
Examples:

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --out track
--preview preview.png

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --run DATA/RUN
--clock clock.jpg

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --interval 2
--without-marker --annotations annotations.toml --out track

zebro-lab track composite.jpg --camera camera.toml --floor floor.toml --robot robot.toml
--merged pasted --interval 4 --out track
"""


class MergedAs(StrEnum):
    """How the exposures of a composite picture were merged."""

    PASTED = "pasted"
    DARKEST = "darkest"
    MEAN = "mean"


Photos = Annotated[
    Path, typer.Argument(help="Folder of photographs, a video, or one composite picture.")
]
CameraToml = Annotated[Path, typer.Option("--camera", help="camera.toml.")]
FloorToml = Annotated[Path, typer.Option("--floor", help="floor.toml.")]
RobotToml = Annotated[
    Path | None, typer.Option("--robot", help="robot.toml; the thesis's robot without it.")
]
Out = Annotated[Path | None, typer.Option(help="Folder to write; RUN/track without it.")]
Run = Annotated[Path | None, typer.Option(metavar="RUN", help="Run folder they belong to.")]
Interval = Annotated[
    float | None, typer.Option(help="Interval of the timer, where there is no EXIF [s].")
]
Times = Annotated[
    Path | None, typer.Option(metavar="CSV", help="Times: columns photo, t_s, maybe t_sigma.")
]
Every = Annotated[
    float | None, typer.Option(min=0.0, help="Time between a video's frames; 0.5, 0 takes all [s].")
]
Clock = Annotated[
    Path | None, typer.Option(metavar="PHOTO", help="Photograph of `zebro-lab camera clock`.")
]
Start = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="Moment to count time from, as the camera shows it."),
]
Marker = Annotated[
    str | None,
    typer.Option(
        metavar="DICTIONARY:NUMBER:SIDE",
        help="What is printed on the robot, as in 4x4_50:0:120mm; robot.toml's without it.",
    ),
]
WithoutMarker = Annotated[
    bool, typer.Option("--without-marker", help="Track the robot by its own annotated picture.")
]
HowMerged = Annotated[
    MergedAs | None,
    typer.Option("--merged", help="How one composite picture was made of its exposures."),
]
AnnotationsToml = Annotated[
    Path | None, typer.Option("--annotations", help="What `zebro-lab annotate` wrote.")
]
BodyHeight = Annotated[
    str | None,
    typer.Option(metavar="LENGTH", help="Height of the body's centre; the marker's without it."),
]
HeightSd = Annotated[
    str, typer.Option("--height-sd", metavar="LENGTH", help="How far a walk strays from it.")
]
Gap = Annotated[
    float | None, typer.Option(help="Pause that interrupts the path; 3.5 usual ones [s].")
]
Source = Annotated[
    str | None, typer.Option(help="real, or sim:WHAT; the files' or the run's without it.")
]
Workers = Annotated[int, typer.Option(min=1, help="Processes to use.")]
PreviewPng = Annotated[
    Path | None,
    typer.Option(metavar="PNG", help="Only look at the first photograph, and draw what is found."),
]


def track(
    photos: Photos,
    camera: CameraToml,
    floor: FloorToml,
    robot: RobotToml = None,
    out: Out = None,
    run: Run = None,
    interval: Interval = None,
    times: Times = None,
    every: Every = None,
    clock: Clock = None,
    start: Start = None,
    marker: Marker = None,
    without_marker: WithoutMarker = False,
    merged: HowMerged = None,
    annotations: AnnotationsToml = None,
    body_height: BodyHeight = None,
    height_sd: HeightSd = "5mm",
    gap: Gap = None,
    source: Source = None,
    workers: Workers = 2,
    preview: PreviewPng = None,
) -> None:
    """Track the robot in photographs: track.csv with covariance, TUM, pictures."""
    from tracking.composite import Merged
    from zebro_lab.files.units import quantity_to_si
    from zebro_lab.track.photo_sequence import FRAME_STEP, TimeRequest
    from zebro_lab.track.request import TrackRequest

    request = TrackRequest(
        photos,
        camera,
        floor,
        robot=robot,
        out=out,
        run=run,
        times=TimeRequest(interval, times, clock, FRAME_STEP if every is None else every),
        start=None if start is None else _moment(start),
        marker=marker,
        without_marker=without_marker,
        merged=None if merged is None else Merged(merged.value),
        annotations=annotations,
        body_height=None if body_height is None else quantity_to_si(body_height, "m"),
        height_sd=quantity_to_si(height_sd, "m"),
        gap=gap,
        source=source,
        workers=workers,
    )
    if preview is not None:
        _preview(request, preview)
        return
    if out is None and run is None:
        raise typer.BadParameter("needed, or --out FOLDER", param_hint="'--run'")
    _track(request)


def _moment(text: str) -> datetime:
    from datetime import UTC

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


def _track(request: "TrackRequest") -> None:
    from rich.console import Console

    from tracking.errors import TrackStopped
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.track.inputs import HowMergedUnknown
    from zebro_lab.track.stage import track as run_stage

    try:
        with progress_bar(Console(stderr=True)) as watcher:
            result = run_stage(request, watcher)
    except TrackStopped as stopped:
        say(str(stopped), err=True)
        raise typer.Exit(INTERRUPTED) from None
    except HowMergedUnknown as unknown:
        raise typer.BadParameter(unknown.problem, param_hint="'--merged'") from unknown
    for line in track_lines(result):
        say(line)


def track_lines(result: "TrackResult") -> list[str]:
    """Format the result: what was tracked, how well, what was left out and what was written."""
    import numpy as np

    from zebro_lab.track.folder import written

    track, fit = result.tracked.track, result.tracked.floor.fit
    spread = np.sqrt(np.diagonal(track.covariance, axis1=1, axis2=2))
    simulated = "SIMULATED " if result.source.startswith("sim:") else ""
    moves = np.where(track.gap_before[1:], 0.0, np.hypot(*np.diff(track.poses[:, :2], axis=0).T))
    lost = list(result.tracked.lost.items())
    what = "exposures" if result.is_composite else "photographs"
    return [
        f"{simulated}track (source {result.source}): {len(track.t)} of {result.photos} "
        f"{what}, {track.t[-1] - track.t[0]:.4g} s, {moves.sum():.3f} m",
        f"times: {result.times}",
        f"standard deviations (median): x {1e3 * np.median(spread[:, 0]):.2f} mm, "
        f"y {1e3 * np.median(spread[:, 1]):.2f} mm, "
        f"yaw {np.degrees(np.median(spread[:, 2])):.3f} deg",
        f"floor: marks are off by {fit.misfit_px:.3f} px (rms), camera "
        f"{fit.stands[0].pose.position[2]:.3f} m high",
        *(f"left out: {photo}: {reason}" for photo, reason in lost[:_MOST_LISTED]),
        *([f"left out: {len(lost) - _MOST_LISTED} more, see manifest.json"]
          if len(lost) > _MOST_LISTED else []),
        *(f"WARNING: {note}" for note in result.tracked.notes),
        f"\nwritten to {result.folder}:",
        *(f"  {file}" for file in written(result.folder)),
    ]  # fmt: skip


def _preview(request: "TrackRequest", file: Path) -> None:
    from zebro_lab.track.preview_stage import preview

    seen = preview(request, file)
    for line in preview_lines(seen):
        say(line)
    if any(check.is_off for check in seen.tape):
        sys.stderr.write("tape and photograph disagree; measure the floor again\n")


def preview_lines(seen: "Preview") -> list[str]:
    """Format what the first photograph shows."""
    from math import degrees

    lines = [
        f"{seen.photo}: marks {', '.join(seen.marks)} are seen, off by {seen.misfit_px:.2f} px",
        f"not seen: {', '.join(seen.unseen)}" if seen.unseen else "every mark of the floor is seen",
        f"camera {seen.camera_height:.3f} m over the floor; a pixel is {1e3 * seen.scale:.2f} mm",
    ]
    if seen.robot is None:
        lines.append("the robot's marker is not seen")
    else:
        x, y, yaw = seen.robot
        lines.append(
            f"robot at x {x:.3f} m, y {y:.3f} m, yaw {degrees(yaw):.1f} deg; its marker is "
            f"{seen.robot_side_px:.0f} px wide"
        )
    lines += [
        f"  {a} to {b}: tape {check.tape:.4f} m, photograph {check.seen:.4f} m"
        f"{'  <-- off' if check.is_off else ''}"
        for check in seen.tape
        for a, b in [check.marks]
    ]
    return [*lines, f"wrote {seen.file}"]
