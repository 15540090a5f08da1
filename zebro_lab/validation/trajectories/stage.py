# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab validate REFERENCE ESTIMATE`: compare two trajectories, write the folder."""

from dataclasses import replace
from pathlib import Path

from model.tasks import Watcher
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.columns import COLUMNS_FILE, TRACK, Columns
from zebro_lab.tables.columns_file import parse_mapped_columns
from zebro_lab.tables.columns_sections import (
    columns_above,
    read_nearest,
    read_section,
    require_checked,
)
from zebro_lab.track.trajectory.file import Trajectory, read_trajectory
from zebro_lab.track.trajectory.table import MAPPED_UNITS
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


def trajectory_columns(file: Path, named: Path | None) -> Columns | None:
    """Read the column map of a trajectory; None if nothing is stated.

    It is the section `[track]` of the file that is named, or of the nearest `columns.toml`, from
    the trajectory's folder upwards, with the nearest source that is stated; a named file without
    this section is taken as a whole.

    Args:
        file: The trajectory.
        named: A `columns.toml`; None for the nearest.

    Raises:
        NotFound: The named file does not exist.
        SettingsError: It cannot be read as TOML, a key, a unit or a sign is invalid, or a value is
            a guess that nobody has checked.
    """
    if named is None:
        entries = read_nearest(TRACK, file.parent)
    else:
        document = read_toml_document(named, advice=f"expected a {COLUMNS_FILE}")
        entries = read_section(TRACK, named) if TRACK in document else _whole(document, named)
    if entries is None or entries.empty:
        return None
    return parse_mapped_columns(entries, MAPPED_UNITS, with_rows=True)


def _whole(document: dict[str, object], file: Path) -> SettingsTable:
    require_checked(document, file=file)
    return SettingsTable(document, file=file)
