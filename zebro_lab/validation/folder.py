# SPDX-License-Identifier: MIT
"""Write a validation folder; only this module depends on its format."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from model.arrays import Array
from model.errors import InsufficientData
from model.judgement import Judged, TiltJudged
from model.metrics.bootstrap import Interval, bootstrap_mean
from model.metrics.path_errors import pose_errors
from model.poses import Poses
from zebro_lab.files.picture_format import PictureFormat, in_every_format
from zebro_lab.files.result_folder import ResultKind, result_folder
from zebro_lab.files.source_names import is_simulated
from zebro_lab.track.file import tum_lines
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.validation.pictures import draw_validation
from zebro_lab.validation.predicted_walks import ShownRun

SCHEMA = 1
METRICS, ERRORS = "metrics.csv", "errors.csv"
VALIDATION = ResultKind(
    "validation", "validate", (METRICS, ERRORS, "*.tum", *in_every_format("*")), SCHEMA
)
MEANS = ("ate_m", "ate_of_length", "ate_aligned_m", "yaw_rms_deg", "energy_m", "crps_yaw_deg")
"""Metrics that are averaged over runs."""


@dataclass(frozen=True)
class Summary:
    """A metric over several runs.

    Attributes:
        model: Name of the prediction or of a baseline.
        metric: Name of a column of `metrics.csv`.
        interval: Mean over runs with its 90 % bootstrap interval, in the metric's unit.
    """

    model: str
    metric: str
    interval: Interval


def metrics(judged: Judged) -> dict[str, float]:
    """Return errors and scores of a prediction or baseline, by column of `metrics.csv`.

    Each value is in the unit that ends the column's name; NaN where it is not known. Columns of the
    band are there only if it has a width.
    """
    errors, scores = judged.errors, judged.scores
    row = {
        "poses": float(errors.poses),
        "length_m": errors.length,
        "length_ratio": errors.length_ratio,
        "ate_m": errors.ate,
        "ate_of_length": errors.ate_of_length,
        "x_rms_m": errors.x,
        "y_rms_m": errors.y,
        "along_rms_m": errors.along,
        "cross_rms_m": errors.cross,
        "yaw_rms_deg": float(np.degrees(errors.yaw)),
        "largest_m": errors.largest,
        "final_m": errors.final_distance,
        "final_yaw_deg": float(np.degrees(errors.final_yaw)),
        "ate_aligned_m": errors.ate_aligned,
        "alignment_yaw_deg": float(np.degrees(errors.alignment_yaw)),
        "radius_m": errors.radius[0],
        "radius_tracked_m": errors.radius[1],
        "yaw_rate_deg_s": float(np.degrees(errors.yaw_rate[0])),
        "yaw_rate_tracked_deg_s": float(np.degrees(errors.yaw_rate[1])),
        "energy_m": scores.energy,
        "crps_x_m": float(scores.crps[0]),
        "crps_y_m": float(scores.crps[1]),
        "crps_yaw_deg": float(np.degrees(scores.crps[2])),
    }
    for each in errors.relative:
        row[f"rpe_{each.distance:g}m_m"] = each.position
        row[f"rpe_{each.distance:g}m_deg"] = float(np.degrees(each.yaw))
    row.update(_band_metrics(judged))
    return row


def _band_metrics(judged: Judged) -> dict[str, float]:
    """Return a band's coverage, width and consistency by column; empty without a band's width."""
    scores, row = judged.scores, {}
    if not np.any(scores.width > 0):
        return row
    for i, level in enumerate(scores.levels):
        for j, (state, unit, scale) in enumerate(
            (("x", "m", 1.0), ("y", "m", 1.0), ("yaw", "deg", 180 / np.pi))
        ):
            row[f"coverage{100 * level:.0f}_{state}"] = float(scores.coverage[i, j])
            row[f"width{100 * level:.0f}_{state}_{unit}"] = float(scores.width[i, j] * scale)
    for each in judged.consistency:
        row[f"{each.name}_p"] = each.p_value
        if each.name == "nees":
            row |= {"nees": each.value, "nees_low": each.low, "nees_high": each.high}
    return row


def tilt_metrics(tilt: TiltJudged) -> dict[str, float]:
    """Return bias, rms, unbiased rms and swing of roll and pitch [deg], and samples, by name."""
    errors, row = tilt.errors, {"samples": float(tilt.errors.samples)}
    for i, angle in enumerate(("roll", "pitch")):
        for name in ("bias", "rms", "rms_unbiased", "swing"):
            row[f"{angle}_{name}_deg"] = float(np.degrees(getattr(errors, name)[i]))
    return row


def summarise_runs(runs: Sequence[JudgedRun], *, rng: np.random.Generator) -> list[Summary]:
    """Compute the mean of each metric in `MEANS` over runs, by model, with bootstrap intervals.

    Whole runs are resampled. A metric that is finite for fewer than two runs gets no summary.

    Args:
        runs: Errors of runs with the same models; the models are those of the first.
        rng: Random number generator of the bootstrap.
    """
    summaries = []
    for name in [row.name for row in runs[0].rows]:
        rows = [metrics(row) for run in runs for row in run.rows if row.name == name]
        for metric in MEANS:
            values = np.array([row[metric] for row in rows])
            try:
                interval = bootstrap_mean(values[np.isfinite(values)], rng=rng)
            except InsufficientData:
                continue
            summaries.append(Summary(name, metric, interval))
    return summaries


def write_validation(
    out: Path,
    shown: Sequence[ShownRun],
    *,
    summary: Sequence[Summary],
    settings: Mapping[str, object],
    inputs: Mapping[str, str],
    source: str,
    form: PictureFormat = "png",
) -> None:
    """Write the folder: metrics, errors pose by pose, TUM files for evo, pictures, manifest.

    Args:
        out: Folder to create or replace.
        shown: Errors of each walk, with the content of the pictures.
        summary: Means of metrics over runs, for the manifest.
        settings: Settings of the validation, JSON-serialisable.
        inputs: SHA-256 of each file that was read.
        source: Where prediction and track come from.
        form: Format of the pictures.

    Raises:
        AlreadyExists, NotWritten: As in `result_folder`.
    """
    runs = [each.run for each in shown]
    notes = [f"{run.name}: {note}" for run in runs for note in run.notes]
    content = {
        "source": source,
        "settings": settings,
        "runs": {run.name: {row.name: metrics(row) for row in run.rows} for run in runs},
        "imu": {run.name: tilt_metrics(run.tilt) for run in runs if run.tilt is not None},
        "notes": notes,
        "over_runs": [
            {"model": s.model, "metric": s.metric, **s.interval._asdict()} for s in summary
        ],
        "inputs": inputs,
    }
    with result_folder(out, VALIDATION, content=content) as draft:
        _write_tables(draft, runs)
        for each in shown:
            undrawn = draw_validation(draft, each, simulated=is_simulated(source), form=form)
            # The manifest, written last, holds this list.
            notes += [f"{each.run.name}: {why}" for why in undrawn]


def _write_tables(draft: Path, runs: Sequence[JudgedRun]) -> None:
    """Write metrics, errors of each pose, and TUM files of track and prediction of each run."""
    table = [{"run": run.name, "model": r.name, **metrics(r)} for run in runs for r in run.rows]
    to_csv(pd.DataFrame(table), draft / METRICS)
    parts = []
    for run in runs:
        for row in run.rows:
            columns = error_columns(row.path.at(run.track.t), run.track)
            parts.append(pd.DataFrame({"run": run.name, "model": row.name, **columns}))
        (draft / f"{run.name}.track.tum").write_text(tum_lines(run.track), encoding="utf-8")
        matched = run.rows[0].path.at(run.track.t)
        (draft / f"{run.name}.predicted.tum").write_text(tum_lines(matched), encoding="utf-8")
    to_csv(pd.concat(parts), draft / ERRORS)


def error_columns(path: Poses, track: Poses) -> dict[str, Array]:
    """Return the errors of each pose of a path by column of `errors.csv`, shape (n,) each.

    Args:
        path: Predicted or estimated poses.
        track: Tracked poses at the same times.
    """
    errors = pose_errors(path, track)
    return {
        "t": errors.t, "x_m": errors.translation[:, 0], "y_m": errors.translation[:, 1],
        "along_m": errors.along, "cross_m": errors.cross, "yaw_rad": errors.rotation,
    }  # fmt: skip


def to_csv(table: pd.DataFrame, file: Path) -> None:
    """Write a table as CSV, numbers with 8 digits."""
    table.to_csv(file, index=False, float_format="%.8g", lineterminator="\n")
