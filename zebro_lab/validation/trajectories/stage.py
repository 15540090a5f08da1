# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab validate REFERENCE ESTIMATE`: compare two trajectories, write the folder."""

from dataclasses import replace
from pathlib import Path

from model.progress import Watcher
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.tables.columns_file import columns_above
from zebro_lab.tables.table_kinds import TRACK
from zebro_lab.track.trajectory.file import Trajectory, read_trajectory
from zebro_lab.track.trajectory.mapping import trajectory_columns
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.trajectories.folder import TRAJECTORIES, write_trajectories
from zebro_lab.validation.trajectories.pair import JudgedPair, judge_pair


def validate_trajectories(request: ValidateRequest, watcher: Watcher) -> JudgedPair:
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
    files = request.runs
    require_replaceable(request.folder, TRAJECTORIES, inputs=files)
    watcher.step("reading", None)
    reference, estimate = (_read(file, request, i) for i, file in enumerate(files))
    watcher.step("judging", 0.5)
    judged = judge_pair(
        reference,
        estimate,
        max_difference=request.max_difference,
        time_offset=request.time_offset,
        distances=request.distance,
        correct_scale=request.correct_scale,
    )
    settings = {
        "plane": str(reference.plane),
        "forward": str(reference.forward),
        "max_difference": request.max_difference,
        "time_offset": request.time_offset,
        "correct_scale": request.correct_scale,
    }
    write_trajectories(request.folder, judged, settings=settings, form=request.form)
    return judged


def _read(file: Path, request: ValidateRequest, which: int) -> Trajectory:
    """Read one of the files, with the source that a `columns.toml` states, whatever its layout."""
    mapping = trajectory_columns(file, request.columns)
    found = read_trajectory(
        file, request.trajectory, mapping=mapping, which=which, topic=request.topic_of(which)
    )
    source = found.source if mapping is None or mapping.source is None else mapping.source
    above = columns_above(TRACK, file, request.columns)
    return replace(found, source=source, notes=(*found.notes, *above))
