# SPDX-License-Identifier: MIT
"""Lines that `track` prints: length, accuracy, what was left out; and those of its preview."""

import numpy as np

from model.poses import Poses
from model.travel import path_length
from tracking.contributions import contributions, shared_part
from tracking.path import Track
from tracking.photos.preview import PhotoPreview
from zebro_lab.files.source_names import is_simulated
from zebro_lab.track.folder import written
from zebro_lab.track.stage import TrackResult

_MOST_LISTED = 10
_WORTH_ADVICE = 0.3  # part of a variance that photographs share


def track_lines(result: TrackResult) -> list[str]:
    """Format a track as lines: length, times, accuracy, floor, left-out photographs, notes, files.

    Of the left-out photographs the first ten are listed; notes are shown as warnings.
    """
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


def _uncertainty_lines(track: Track) -> list[str]:
    """Format the share of the variance that is of errors common to all photographs.

    Where it is above `_WORTH_ADVICE`, the largest cause is named, with advice.
    """
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


def preview_lines(seen: PhotoPreview) -> list[str]:
    """Format a preview as lines: marks, camera height, robot, floor distances by tape measure."""
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
            f"robot at x {x:.3f} m, y {y:.3f} m, yaw {np.degrees(yaw):.1f} deg; its marker is "
            f"{seen.robot_side_px:.0f} px wide"
        )
    pairs = [
        f"  {a} to {b}: tape measure {check.tape:.4f} m, photograph {check.seen:.4f} m"
        f"{'  <-- off' if check.is_off else ''}"
        for check in seen.tape
        for a, b in [check.marks]
    ]
    return [*lines, *pairs, *(f"WARNING: {each}" for each in seen.warnings)]
