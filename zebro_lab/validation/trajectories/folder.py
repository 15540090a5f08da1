# SPDX-License-Identifier: MIT
"""Write the folder of a validated trajectory; only this module depends on its format."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from model.metrics.path_errors import pose_errors
from model.metrics.rigid_errors import rotation_angles
from zebro_lab.files.picture_format import PictureFormat, in_every_format
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import ResultKind, result_folder
from zebro_lab.track.file import tum_lines
from zebro_lab.validation.trajectories.pair import Errors, JudgedPair

SCHEMA = 1
METRICS, ERRORS, PICTURE = "metrics.csv", "errors.csv", "trajectories"
REFERENCE, ESTIMATE = "reference.tum", "estimate.tum"
TRAJECTORIES = ResultKind(
    "trajectories",
    "validate",
    (METRICS, ERRORS, *in_every_format(PICTURE), REFERENCE, ESTIMATE),
    SCHEMA,
)


def metrics(row: Errors) -> dict[str, float]:
    """Return the errors in one space by column of `metrics.csv`, whose names end in the unit."""
    errors = row.errors
    found = {
        "poses": float(errors.poses),
        "length_m": errors.length,
        "scale": errors.scale,
        "ate_m": errors.ate.rms,
        "ate_mean_m": errors.ate.mean,
        "ate_median_m": errors.ate.median,
        "ate_largest_m": errors.ate.largest,
        "ate_aligned_m": errors.aligned.rms,
        "ate_aligned_mean_m": errors.aligned.mean,
        "ate_aligned_median_m": errors.aligned.median,
        "ate_aligned_largest_m": errors.aligned.largest,
        "alignment_deg": float(np.degrees(rotation_angles(errors.alignment.rotation[None])[0])),
        "rotation_rms_deg": float(np.degrees(errors.rotation)),
    }
    for each in (errors.steps, *errors.relative):
        name = "step" if each.distance is None else f"{each.distance:g}m"
        found[f"rpe_{name}_m"] = each.position
        found[f"rpe_{name}_deg"] = float(np.degrees(each.angle))
        found[f"rpe_{name}_pairs"] = float(each.pairs)
    return found


def write_trajectories(
    out: Path, judged: JudgedPair, *, settings: Mapping[str, object], form: PictureFormat = "png"
) -> None:
    """Write the folder: metrics, errors pose by pose, matched poses, picture, manifest.

    Args:
        out: Folder to create or replace.
        judged: The errors.
        settings: Settings of the validation, JSON-serialisable.
        form: Format of the picture.

    Raises:
        AlreadyExists, NotWritten: As in `result_folder`.
    """
    from zebro_lab.plots import save
    from zebro_lab.validation.trajectories.pictures import trajectories

    both = (judged.reference, judged.estimate)
    content = {
        "source": judged.source,
        "settings": settings,
        "layouts": [each.layout for each in both],
        "metrics": {row.where: metrics(row) for row in judged.rows},
        "notes": list(judged.notes),
        "inputs": file_hashes(dict.fromkeys(file for each in both for file in each.files)),
    }
    with result_folder(out, TRAJECTORIES, content=content) as draft:
        _write_tables(draft, judged)
        (draft / REFERENCE).write_text(tum_lines(judged.tracked))
        (draft / ESTIMATE).write_text(tum_lines(judged.estimated))
        save(trajectories(judged), draft / f"{PICTURE}.{form}")


def _write_tables(draft: Path, judged: JudgedPair) -> None:
    table = [{"in": row.where, **metrics(row)} for row in judged.rows]
    errors = pose_errors(judged.estimated, judged.tracked)
    columns = {
        "t": errors.t, "x_m": errors.translation[:, 0], "y_m": errors.translation[:, 1],
        "along_m": errors.along, "cross_m": errors.cross, "yaw_rad": errors.rotation,
    }  # fmt: skip
    poses = pd.DataFrame(columns)
    for row in judged.rows[1:]:
        difference = row.estimate.position - row.reference.position
        poses[f"distance_in_{row.where}_m"] = np.linalg.norm(difference, axis=1)
    poses["t"] = [f"{t:.9f}" for t in errors.t]
    for name, frame in ((METRICS, pd.DataFrame(table)), (ERRORS, poses)):
        frame.to_csv(draft / name, index=False, float_format="%.8g", lineterminator="\n")
