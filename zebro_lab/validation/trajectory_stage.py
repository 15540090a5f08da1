# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab validate REFERENCE ESTIMATE`: compare two trajectories, write the folder."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from model.metrics.rigid_errors import rotation_angles
from model.tasks import Watcher
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import ResultKind, require_replaceable, result_folder
from zebro_lab.tables.columns import TRACK
from zebro_lab.tables.columns_file import read_mapped_columns
from zebro_lab.tables.columns_sections import columns_above
from zebro_lab.track.file import tum_lines
from zebro_lab.track.trajectory.file import Trajectory, read_trajectory
from zebro_lab.track.trajectory.request import of_file
from zebro_lab.track.trajectory.table import MAPPED_UNITS
from zebro_lab.validation.folder import ERRORS, METRICS, error_columns, to_csv
from zebro_lab.validation.pictures import draw_pair
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.trajectory_pair import Errors, JudgedPair, judge_pair

PICTURE, REFERENCE, ESTIMATE = "trajectories", "reference.tum", "estimate.tum"
TRAJECTORIES = ResultKind(
    "trajectories",
    "validate",
    (METRICS, ERRORS, *in_every_format(PICTURE), REFERENCE, ESTIMATE),
    schema=1,
)


def validate_pair(request: ValidateRequest, watcher: Watcher) -> JudgedPair:
    """Compute the errors of an estimated trajectory against a reference; write the folder.

    Args:
        request: Two files as `runs`, how to read them, and the folder to write.
        watcher: Receives progress.

    Returns:
        The errors.

    Raises:
        ZebroLabError: A file is missing or damaged, the two do not match, or the folder cannot be
            replaced.
    """
    require_replaceable(request.folder, TRAJECTORIES, inputs=request.runs)
    watcher.step("reading", None)
    reference, estimate = (_read(file, request, i) for i, file in enumerate(request.runs))
    watcher.step("judging", 0.5)
    how = {
        "max_difference": request.max_difference,
        "time_offset": request.time_offset,
        "correct_scale": request.correct_scale,
    }
    judged = judge_pair(reference, estimate, distances=request.distance, **how)
    settings = {"plane": str(reference.plane), "forward": str(reference.forward), **how}
    _write(request, judged, settings)
    return judged


def _read(file: Path, request: ValidateRequest, which: int) -> Trajectory:
    """Read a trajectory; a source stated in its `columns.toml` applies to files of any layout.

    Args:
        file: The file.
        request: How files are read.
        which: 0 for the reference, 1 for the estimate.
    """
    mapping, topic = read_mapped_columns(TRACK, file, request.columns, MAPPED_UNITS, alone=True)
    trajectory = read_trajectory(
        file, request.trajectory, mapping=mapping, which=which,
        topic=of_file(request.topic, which) or topic,
    )  # fmt: skip
    above = columns_above(TRACK, file, request.columns)
    return replace(trajectory, notes=(*trajectory.notes, *above))


def pair_metrics(row: Errors) -> dict[str, float]:
    """Return the errors in one space by column of `metrics.csv`, whose names end in the unit."""
    errors = row.errors
    columns = {"poses": float(errors.poses), "length_m": errors.length, "scale": errors.scale}
    for name, each in (("ate", errors.ate), ("ate_aligned", errors.aligned)):
        columns |= {
            f"{name}_m": each.rms, f"{name}_mean_m": each.mean, f"{name}_median_m": each.median,
            f"{name}_largest_m": each.largest,
        }  # fmt: skip
    turn = rotation_angles(errors.alignment.rotation[None])[0]
    columns["alignment_deg"] = float(np.degrees(turn))
    columns["rotation_rms_deg"] = float(np.degrees(errors.rotation))
    for each in (errors.steps, *errors.relative):
        name = "step" if each.distance is None else f"{each.distance:g}m"
        columns[f"rpe_{name}_m"] = each.position
        columns[f"rpe_{name}_deg"] = float(np.degrees(each.angle))
        columns[f"rpe_{name}_pairs"] = float(each.pairs)
    return columns


def _write(request: ValidateRequest, judged: JudgedPair, settings: dict[str, object]) -> None:
    """Write the folder: metrics, errors pose by pose, matched poses, picture, manifest."""
    both = (judged.reference, judged.estimate)
    metrics = {row.where: pair_metrics(row) for row in judged.rows}
    content = {
        "source": judged.source,
        "settings": settings,
        "layouts": [each.layout for each in both],
        "metrics": metrics,
        "notes": list(judged.notes),
        "inputs": file_hashes(dict.fromkeys(file for each in both for file in each.files)),
    }
    poses = pd.DataFrame(error_columns(judged.estimated, judged.tracked))
    for row in judged.rows[1:]:
        difference = row.estimate.position - row.reference.position
        poses[f"distance_in_{row.where}_m"] = np.linalg.norm(difference, axis=1)
    poses["t"] = [f"{t:.9f}" for t in judged.tracked.t]
    with result_folder(request.folder, TRAJECTORIES, content=content) as draft:
        to_csv(
            pd.DataFrame([{"in": where, **row} for where, row in metrics.items()]), draft / METRICS
        )
        to_csv(poses, draft / ERRORS)
        (draft / REFERENCE).write_text(tum_lines(judged.tracked), encoding="utf-8")
        (draft / ESTIMATE).write_text(tum_lines(judged.estimated), encoding="utf-8")
        draw_pair(draft / f"{PICTURE}.{request.form}", judged)
