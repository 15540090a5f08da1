# SPDX-License-Identifier: MIT
"""`zebro-lab track`: the path of a robot from photographs."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command
from zebro_lab.track.request import TrackRequest

if TYPE_CHECKING:
    from tracking.path import Track
    from tracking.photos.preview import Preview
    from zebro_lab.track.stage import TrackResult

_MOST_LISTED = 10
_WORTH_ADVICE = 0.3  # part of a variance that photographs share

EPILOG = """
Examples:

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --out track
--preview preview.png

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --run DATA/RUN
--clock clock.jpg

zebro-lab track photos --camera camera.toml --floor floor.toml --robot robot.toml --interval 2
--without-marker --annotations annotations.toml --out track

zebro-lab track composite.jpg --camera camera.toml --floor floor.toml --robot robot.toml
--interval 4 --out track
"""


PreviewPng = Annotated[
    Path | None,
    typer.Option(
        metavar="PNG", help="Analyse only the first photograph, and draw what is found in it."
    ),
]


@request_command()
def track(request: TrackRequest, preview: PreviewPng = None, output: Output = TEXT) -> None:
    """Track the robot in photographs; write track.csv with covariance, track.tum, pictures."""
    if preview is not None:
        _preview(request, preview, output)
        return
    if request.out is None and request.run is None:
        raise typer.BadParameter("missing: give --run RUN or --out FOLDER", param_hint="'--run'")
    _track(request, output)


def _track(request: TrackRequest, output: Output) -> None:
    from tracking.errors import TrackStopped
    from zebro_lab.track.stage import track as run_stage

    with output.progress(TrackStopped) as watcher:
        result = run_stage(request, watcher)
    for line in track_lines(result):
        output.say(line)
    _print_document(result, output)


def _print_document(result: "TrackResult", output: Output) -> None:
    track = result.tracked.track
    content = {"folder": result.folder, "simulated": is_simulated(result.source)}
    numbers = {
        "source": result.source,
        "photographs": result.photos,
        "poses": len(track.t),
        "duration_s": track.t[-1] - track.t[0],
    }
    notes = {"left_out": dict(result.tracked.lost), "notes": list(result.tracked.notes)}
    output.document("track", {**content, **numbers, **notes})


def track_lines(result: "TrackResult") -> list[str]:
    """Format a track as lines: length, times, accuracy, floor, left-out photographs, notes, files.

    Of the left-out photographs the first ten are listed; notes are shown as warnings.
    """
    import numpy as np

    from model.poses import Poses
    from model.travel import path_length
    from zebro_lab.track.folder import written

    track, fit = result.tracked.track, result.tracked.floor.fit
    spread = np.sqrt(np.diagonal(track.covariance, axis1=1, axis2=2))
    simulated = "SIMULATED " if is_simulated(result.source) else ""
    walked = Poses.of_states(np.asarray(track.t, dtype=float), np.asarray(track.poses, dtype=float))
    parts = np.split(np.arange(len(walked)), np.flatnonzero(track.gap_before))
    length = sum(path_length(walked.part(part)) for part in parts)
    lost = list(result.tracked.lost.items())
    what = "exposures" if result.is_composite else "photographs"
    return [
        f"{simulated}track (source {result.source}): {len(track.t)} of {result.photos} "
        f"{what}, duration {track.t[-1] - track.t[0]:.4g} s, length {length:.3f} m",
        f"times: {result.times}",
        f"standard deviations (median): x {1e3 * np.median(spread[:, 0]):.2f} mm, "
        f"y {1e3 * np.median(spread[:, 1]):.2f} mm, "
        f"yaw {np.degrees(np.median(spread[:, 2])):.3f} deg",
        *_uncertainty_lines(track),
        *(f"{photo}: {each.sides} of 4 edges of the robot's top refined the clicks, by "
          f"{each.moved:.2f} px (rms)" for photo, each in result.tracked.corners.items()),
        *([] if result.tracked.next_annotation is None
          else [result.tracked.next_annotation.sentence]),
        f"floor: marks are off by {fit.misfit_px:.3f} px (rms), camera "
        f"{fit.stands[0].pose.position[2]:.3f} m high",
        *(f"left out: {photo}: {reason}" for photo, reason in lost[:_MOST_LISTED]),
        *([f"left out: {len(lost) - _MOST_LISTED} more, see manifest.json"]
          if len(lost) > _MOST_LISTED else []),
        *(f"WARNING: {note}" for note in result.tracked.notes),
        "",
        f"written to {result.folder}:",
        *(f"  {file}" for file in written(result.folder)),
    ]  # fmt: skip


def _uncertainty_lines(track: "Track") -> list[str]:
    """Format which part of the variance all photographs share, and the largest cause of it."""
    from tracking.contributions import contributions, shared_part

    (position, yaw), causes = shared_part(track), contributions(track)
    kinds = (
        ("x and y", position, {each: each.position for each in causes}),
        ("yaw", yaw, {each: each.yaw for each in causes}),
    )
    lines = []
    for what, part, parts in kinds:
        line = f"of the variance of {what}, {part:.0%} is of errors that all photographs share"
        if parts and part > _WORTH_ADVICE:
            most = max(parts, key=lambda each: parts[each])
            line += (
                f"; {parts[most]:.0%} would go if the {most.cause} were known: to shrink it, "
                f"{most.advice}"
            )
        lines.append(line)
    return lines


def _preview(request: TrackRequest, file: Path, output: Output) -> None:
    from zebro_lab.track.preview_stage import preview

    seen = preview(request, file)
    for line in (*preview_lines(seen), f"wrote {file}"):
        output.say(line)
    output.document("track", {"written": [file]})
    if any(check.is_off for check in seen.tape):
        sys.stderr.write("distances marked off differ by over 4 mm; measure the floor again\n")


def preview_lines(seen: "Preview") -> list[str]:
    """Format a preview as lines: marks, camera height, robot, floor distances by tape measure."""
    from math import degrees

    lines = [
        f"{seen.photo}: marks {', '.join(seen.marks)} are seen, off by {seen.misfit_px:.2f} px",
        f"not seen: {', '.join(seen.unseen)}" if seen.unseen else "every mark of the floor is seen",
        f"camera {seen.camera_height:.3f} m over the floor; a pixel is {1e3 * seen.scale:.2f} mm",
    ]
    if seen.robot is None:
        lines.append("the robot's marker is not seen, or is not searched (composite, no marker)")
    else:
        x, y, yaw = seen.robot
        lines.append(
            f"robot at x {x:.3f} m, y {y:.3f} m, yaw {degrees(yaw):.1f} deg; its marker is "
            f"{seen.robot_side_px:.0f} px wide"
        )
    pairs = [
        f"  {a} to {b}: tape measure {check.tape:.4f} m, photograph {check.seen:.4f} m"
        f"{'  <-- off' if check.is_off else ''}"
        for check in seen.tape
        for a, b in [check.marks]
    ]
    return [*lines, *pairs, *(f"WARNING: {each}" for each in seen.warnings)]
