# SPDX-License-Identifier: MIT
"""Draw the figures of a track folder and of a track's preview."""

from collections.abc import Sequence
from pathlib import Path
from typing import IO

import numpy as np

from model.arrays import Array
from tracking.camera import project
from tracking.detect import Detection
from tracking.floor import FloorMap
from tracking.path import Track
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.plots import save
from zebro_lab.plots import track as draw
from zebro_lab.plots.sheet import CYCLE, RED
from zebro_lab.plots.track import SeenMarks
from zebro_lab.track.photographs import PlacedPhoto

_AHEAD = 0.08  # length of a heading's arrow over a photograph [m]
_MARGIN = 0.3  # around path and floor marks on the map [m]
_MOST_MAP_PIXELS = 4e6
_MOST_LABELS = 16


def draw_track(
    folder: Path, track: Track, photo: PlacedPhoto, *, floor: FloorMap,
    detection: Detection | None, title: str, simulated: bool, form: PictureFormat = "png",
) -> None:  # fmt: skip
    """Write `overlay` and `map`, the path over photograph and floor, and `residuals`.

    Args:
        folder: Folder to write the pictures into.
        track: The track.
        photo: Photograph to draw over, with the camera's pose.
        floor: The floor as fitted.
        detection: Markers detected in `photo`; None where none was searched.
        title: Name of the track, appended to each figure's own title.
        simulated: Whether the photographs are simulated; the titles then say so.
        form: Format, and suffix, of the pictures.
    """
    path, ahead = _path_px(track, photo)
    figure = draw.over_photo(
        photo.pixels,
        title=f"Path over a photograph: {title}",
        simulated=simulated,
        path_px=path,
        headings_px=ahead,
        marks=seen_marks(photo, floor, detection),
    )
    save(figure, folder / f"overlay.{form}")
    _draw_map(folder / f"map.{form}", track, photo, floor, title, simulated)
    seen = track.observations
    figure = draw.residual_page(
        track.t,
        track.residuals,
        sd=np.array([np.sqrt(np.diag(each.pose.planar_covariance)) for each in seen]),
        score=np.array([each.score for each in seen]),
        height=np.array([each.z for each in seen]),
        source=[each.source for each in seen],
        title=f"Residuals: {title}",
        simulated=simulated,
    )
    save(figure, folder / f"residuals.{form}")


def draw_preview(
    file: IO[bytes], photo: PlacedPhoto, *, floor: FloorMap, detection: Detection, title: str,
    simulated: bool, command: str,
) -> None:  # fmt: skip
    """Draw a photograph with the floor's marks, projected from the map, and the robot's marker.

    Args:
        file: Open file to which the PNG is written.
        photo: The photograph, with the camera's pose.
        floor: The floor's marks.
        detection: Marks detected in the photograph; only the robot's marker is drawn.
        title: Title of the figure.
        simulated: Whether the photograph is simulated; the figure then says so.
        command: Command to record in the file's metadata.
    """
    marks = seen_marks(photo, floor, detection)
    figure = draw.over_photo(photo.pixels, title=title, simulated=simulated, marks=marks)
    save(figure, file, command=command)


def seen_marks(photo: PlacedPhoto, floor: FloorMap, detection: Detection | None) -> list[SeenMarks]:
    """Compute outlines of the floor's marks, projected from the map, and of the robot's marker.

    Args:
        photo: The photograph, with the camera's pose.
        floor: The floor's marks.
        detection: Marks detected in the photograph; None for the floor alone.

    Returns:
        Outlines [px] with labels and colours: the floor's, then the robot's if it was detected.
    """
    outlines = [project(photo.camera, photo.pose, mark.points) for mark in floor.marks.values()]
    labels = [str(key) for key in floor.marks]
    marks = [SeenMarks(outlines, labels, "mark of the floor", CYCLE[0])]
    if detection is not None and detection.robot is not None:
        label = f"robot {detection.robot.marker_id}"
        marks.append(SeenMarks([detection.robot.corners_px], [label], "marker of the robot", RED))
    return marks


def _path_px(track: Track, photo: PlacedPhoto) -> tuple[Array, Array]:
    """Project the path, and the tips of arrows along its headings, into a photograph.

    Returns:
        Pixels of the n poses and of the n tips, each with a row of NaN inserted at each gap.
    """
    height = np.array([seen.z for seen in track.observations])
    xy, yaw = track.poses[:, :2], track.poses[:, 2]
    step = _AHEAD * np.column_stack((np.cos(yaw), np.sin(yaw)))
    path = project(photo.camera, photo.pose, np.column_stack((xy, height)))
    ahead = project(photo.camera, photo.pose, np.column_stack((xy + step, height)))
    return _broken(path, track), _broken(ahead, track)


def _broken(rows: Array, track: Track) -> Array:
    """Insert a row of NaN before each pose that follows a gap, so that no line crosses the gap."""
    return np.insert(rows, np.flatnonzero(track.gap_before), np.nan, axis=0)


def _draw_map(
    file: Path, track: Track, photo: PlacedPhoto, floor: FloorMap, title: str, simulated: bool
) -> None:  # fmt: skip
    """Draw path and 90 % ellipses over the rectified floor, with a margin around path and marks."""
    places = [track.poses[:, :2], *(mark.points[:, :2] for mark in floor.marks.values())]
    low = np.min([place.min(axis=0) for place in places], axis=0) - _MARGIN
    high = np.max([place.max(axis=0) for place in places], axis=0) + _MARGIN
    scale = min(400.0, float(np.sqrt(_MOST_MAP_PIXELS / np.prod(high - low))))
    picture = photo.from_above(low, high, pixels_per_metre=scale)
    ellipses = [
        ellipse_90(spread[:2, :2]) + pose[:2]
        for spread, pose in zip(track.covariance, track.poses, strict=True)
    ]
    poses = _broken(track.poses, track)
    extent = (float(low[0]), float(high[0]), float(low[1]), float(high[1]))
    figure = draw.over_floor(
        picture, extent=extent, poses=poses, ellipses=ellipses, labels=_time_labels(track, poses),
        title=f"Path over the floor: {title}",
        note=f"photograph of the last pose, {track.t[-1]:.1f} s; raised objects are displaced",
        simulated=simulated,
    )  # fmt: skip
    save(figure, file)


def _time_labels(track: Track, poses: Array) -> Sequence[str]:
    """Return a label for each row of `poses`: the time at about `_MOST_LABELS` rows, else empty.

    Args:
        track: The track.
        poses: Its poses, with a row of NaN at each gap.
    """
    every = max(1, round(len(track.t) / _MOST_LABELS))
    labels = iter(f"{t:.1f} s" if k % every == 0 else "" for k, t in enumerate(track.t))
    return ["" if np.isnan(pose[0]) else next(labels) for pose in poses]


def ellipse_90(covariance: Array) -> Array:
    """Compute the ellipse that holds 90 % of a planar normal density of mean zero.

    Args:
        covariance: Covariance of x and y, shape (2, 2) [m²].

    Returns:
        Points x, y on the ellipse, the last equal to the first, shape (33, 2) [m].
    """
    values, vectors = np.linalg.eigh(covariance)
    angle = np.linspace(0, 2 * np.pi, 33)
    # -2 ln(1 - 0.9) is the 90 % point of chi-squared with two degrees of freedom.
    radii = np.sqrt(np.maximum(values, 0) * -2 * np.log(0.1))
    return np.column_stack((np.cos(angle), np.sin(angle))) * radii @ vectors.T
