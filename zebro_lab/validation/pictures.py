# SPDX-License-Identifier: MIT
"""Pictures of a validation: errors, roll and pitch, and the photographs of the walk."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.errors import TrackingError
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots import save, sheet
from zebro_lab.plots.path_validation import path_validation, tilt
from zebro_lab.plots.photo_poses import Shot, photos_beside_poses
from zebro_lab.track.photographs import PlacedPhoto, TrackedPhotos
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.validation.predicted_walks import ShownRun
from zebro_lab.validation.trajectory_pair import JudgedPair
from zebro_lab.walk.prediction_file import WalkedPath

SHOTS = 4
_CROP = 0.45  # side of the region shown around the robot [m]
_CROP_SCALE = 900.0  # px/m
_MARGIN = 0.3  # around the paths on the floor [m]
_MOST_FLOOR_PIXELS = 1.5e6


def draw_validation(
    folder: Path, shown: ShownRun, *, simulated: bool, form: PictureFormat = "png"
) -> tuple[str, ...]:
    """Draw `RUN.png`, and `RUN.imu.png`, `RUN.photos.png` and `RUN.floor.png` if there are data.

    The latter two need photographs and a prediction from a walk folder.

    Args:
        folder: Folder to write the pictures into.
        shown: Errors, prediction and photographs of the walk.
        simulated: Whether to append "(simulated)" to the titles.
        form: Format, and suffix, of the pictures.

    Returns:
        Notes on pictures that could not be drawn, one line each.
    """
    run = shown.run
    rows = {row.name: row.path for row in run.rows}
    figure = path_validation(rows, run.track, band=run.band, title=run.name, simulated=simulated)
    save(figure, folder / f"{run.name}.{form}")
    if run.tilt is not None:
        seen = run.tilt
        figure = tilt(seen.t, seen.predicted, seen.measured, title=run.name, simulated=simulated)
        save(figure, folder / f"{run.name}.imu.{form}")
    if shown.photos is None:
        return ()
    try:
        _draw_photos(folder, shown, shown.photos, form)
    except TrackingError as error:
        return (f"photographs are not shown: {error}",)
    return ()


def draw_pair(file: Path, judged: JudgedPair) -> None:
    """Draw two trajectories and the estimate aligned with the reference, and their errors.

    Args:
        file: File to write.
        judged: The errors.
    """
    row = judged.rows[0]
    turn = row.errors.alignment.rotation[:, 0]
    aligned = replace(
        judged.estimated, position=row.errors.alignment.apply(row.estimate.position),
        yaw=judged.estimated.yaw + np.arctan2(turn[1], turn[0]),
    )  # fmt: skip
    figure = path_validation(
        {"estimate": judged.estimated, "estimate, aligned": aligned}, judged.tracked, band=None,
        title=judged.title, simulated=is_simulated(judged.source), of="Estimate and reference",
        plane=judged.reference.plane, timed=judged.reference.timed,
    )  # fmt: skip
    save(figure, file)


def _draw_photos(folder: Path, shown: ShownRun, photos: TrackedPhotos, form: PictureFormat) -> None:
    """Draw photographs beside predicted poses, and the band over the floor of the last one.

    Nothing is drawn if the prediction is not from a walk folder.
    """
    run, walk = shown.run, shown.prediction.walk
    rows = _instants(run, photos, shown.time_offset)
    if walk is None or not len(rows):
        return
    views = {int(row): photos.view(photos.names[row]) for row in rows}
    at = {row: float(photos.t[row]) + shown.time_offset for row in views}
    shots = [_shot(run, walk, view, at[row]) for row, view in views.items()]
    figure = photos_beside_poses(
        shots, walk.robot, title=run.name, simulated_photos=photos.simulated
    )
    save(figure, folder / f"{run.name}.photos.{form}")
    # In the last photograph the robot no longer hides the floor at the start of the path.
    last = max(views)
    file = folder / f"{run.name}.floor.{form}"
    _draw_floor(file, run, views[last], at[last], simulated_photos=photos.simulated)


def _instants(run: JudgedRun, photos: TrackedPhotos, time_offset: float) -> NDArray[np.intp]:
    """Return indices of at most `SHOTS` photographs, spread from first to last scored pose."""
    at = photos.t + time_offset
    scored = np.flatnonzero((at >= run.track.t[0] - 1e-6) & (at <= run.track.t[-1] + 1e-6))
    return np.unique(scored[np.linspace(0, len(scored) - 1, SHOTS).round().astype(int)])


def _shot(run: JudgedRun, walk: WalkedPath, view: PlacedPhoto, t: float) -> Shot:
    """Return the photograph around the tracked robot, seen from above, and its predicted pose.

    Height, roll, pitch, leg angles and contacts are those of the walk's sample nearest to time `t`
    [s].
    """
    tracked, predicted = run.track.at([t]), run.rows[0].path.at([t])
    row = int(np.abs(walk.path.t - t).argmin())
    z, (roll, pitch) = walk.path.position[row, 2], walk.path.orientation[row, :2]
    middle = tracked.position[0]
    low, high = middle - _CROP / 2, middle + _CROP / 2
    top = float(z) + walk.robot.body_size[2] / 2
    return Shot(
        t=t,
        picture=view.from_above(low, high, pixels_per_metre=_CROP_SCALE, height=top),
        extent=_extent(low, high),
        tracked=np.append(middle, tracked.yaw[0]),
        position=np.append(predicted.position[0], z),
        orientation=np.array([roll, pitch, predicted.yaw[0]]),
        theta=walk.path.theta[row],
        contact=walk.path.contact[row],
    )


@sheet.styled
def _draw_floor(
    file: Path, run: JudgedRun, view: PlacedPhoto, t: float, *, simulated_photos: bool
) -> None:
    """Draw path, band and track over the rectified floor of a photograph taken at time `t` [s]."""
    path = run.rows[0].path
    places = np.vstack([path.position, run.track.position])
    low, high = places.min(axis=0) - _MARGIN, places.max(axis=0) + _MARGIN
    scale = min(400.0, float(np.sqrt(_MOST_FLOOR_PIXELS / np.prod(high - low))))
    figure, axes = sheet.photograph_axes(
        f"Predicted and tracked path: {run.name} (simulated prediction"
        f"{' and photograph' * simulated_photos})",
        view.from_above(low, high, pixels_per_metre=scale), _extent(low, high), simulated=False,
        note=f"photograph at {t:.1f} s; raised objects are displaced",
    )  # fmt: skip
    sheet.draw_band(axes, run.band, label="draws", lw=0.5, alpha=0.25)
    axes.plot(*path.position.T, color=sheet.BLUE, lw=1.6, label="predicted path")
    axes.plot(
        *run.track.position.T, ls="none", marker="o", ms=4.5, color="black", mec="white", mew=0.6,
        label="track",
    )  # fmt: skip
    sheet.legend_below(figure, columns=3)
    save(figure, file)


def _extent(low: Array, high: Array) -> tuple[float, float, float, float]:
    """Return lowest x, highest x, lowest y and highest y, as matplotlib's `imshow` takes them."""
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])
