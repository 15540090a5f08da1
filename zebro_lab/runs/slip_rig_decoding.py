# SPDX-License-Identifier: MIT
"""Decode raw samples of a recorded slip rig to speeds and forces in SI."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from rig.clock_watch import sample_times
from rig.errors import RigError
from rig.sample_columns import SampleColumns
from rig.slip_rig.decode import (
    decode_board,
    decode_disc_angles,
    decode_forces,
    decode_further_loads,
    decode_speeds,
)
from rig.slip_rig.profile import BoardProfile, DriveProfile, LoadCellProfile, load_rig_profile
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.raw_log import raw_topic
from zebro_lab.runs.manifest import RIG, profile_file
from zebro_lab.runs.slip_rig_table import SlipRigTable

_MANY = 3  # forces per speed sample, above which forces are averaged


def derive_table(
    folder: Path, streams: Mapping[str, SampleColumns], *, zero: Mapping[str, float]
) -> tuple[SlipRigTable, tuple[str, ...]]:
    """Compute speeds and forces of a recorded run from the raw samples of its devices.

    Each sample of a board gives a row. With drives and load cell as separate streams and over
    `_MANY` forces per speed of the leg disc, the rows are those speeds' times, and forces are
    averaged around them (`averages_around`): speeds interpolated to many forces would turn speed
    noise into changes of slip without effect on force. With fewer forces, the rows are the forces'
    times inside the speeds' range, and speeds are interpolated. Drives tell the angles, too. Rows
    whose time does not increase are dropped, with a note.

    Args:
        folder: The run folder, which has the profile.
        streams: Raw streams of the run's log, by topic.
        zero: Zero offsets of the load cell, `zero_normal` and `zero_traction`, to be subtracted;
            0 if absent [N].

    Returns:
        The samples with strictly increasing time, and the note, if any. The lateral force, of which
        no zero is known, is as measured; a board has none.

    Raises:
        DataError: A stream or a drive has no samples, no sample has speeds and forces, or the
            profile is missing, invalid, or has neither a board nor drives with a load cell.
    """
    file = profile_file(folder, RIG)
    try:
        profile = load_rig_profile(str(file))
        if profile.board is not None:
            table = _of_board(profile.board, _require(streams, "board", folder))
        elif profile.drives is not None and profile.load_cell is not None:
            cell, drives = (_require(streams, name, folder) for name in ("load_cell", "drives"))
            table = _of_two(profile.drives, profile.load_cell, drives, cell)
        else:
            raise DataError("lacks [board], or [drives] and [load_cell]; restore it", file=file)
    except RigError as error:
        raise DataError(str(error), file=folder) from error
    if len(table) == 0:
        raise DataError("no force was recorded while both disc speeds are known", file=folder)
    zeroed = replace(
        table,
        normal_force=table.normal_force - zero.get("zero_normal", 0.0),
        traction_force=table.traction_force - zero.get("zero_traction", 0.0),
    )
    return _increasing(zeroed, folder.absolute().name)


def _of_board(profile: BoardProfile, board: SampleColumns) -> SlipRigTable:
    """Return a row for each sample of a board, which measures speeds and forces together."""
    forces, speeds = decode_board(profile, board)
    return SlipRigTable(
        sample_times(board), speeds.leg, speeds.ground, forces.normal, forces.traction
    )


def _of_two(
    drives: DriveProfile, cell: LoadCellProfile, speeds: SampleColumns, forces: SampleColumns
) -> SlipRigTable:
    """Combine the samples of drives and load cell, by averages or interpolation.

    The choice and its reason are those of `derive_table`.
    """
    t = sample_times(forces)
    decoded = decode_forces(cell, forces)
    lateral, _ = decode_further_loads(cell, forces)
    force = np.vstack([decoded.normal, decoded.traction, lateral])
    disc = decode_speeds(drives.leg, drives.ground, speeds)
    speed = np.vstack([disc.leg, disc.ground])
    angle = np.vstack(decode_disc_angles(drives.leg, drives.ground, speeds))
    if len(t) > _MANY * len(disc.time):
        at, around = averages_around(disc.time, t, force)
        return SlipRigTable(disc.time[at], *speed[:, at], *around, *angle[:, at])
    inside = (t >= disc.time[0]) & (t <= disc.time[-1])
    leg, ground, *angles = (np.interp(t[inside], disc.time, row) for row in (*speed, *angle))
    return SlipRigTable(t[inside], leg, ground, *force[:, inside], *angles)


def averages_around(at: Array, t: Array, values: Array) -> tuple[NDArray[np.intp], Array]:
    """Average values around given times; each value counts for the nearest time.

    Values further from the nearest time than the median interval of `at` are dropped, and before
    the first and behind the last time those further than half of it; a single time takes all.

    Args:
        at: Times to average around, increasing, shape (m,) [s].
        t: Times of the values, increasing, shape (n,) [s].
        values: The values, shape (k, n).

    Returns:
        Indices into `at` of the times that have values, shape (j,), and the averages, shape (k, j).
    """
    reach = float(np.median(np.diff(at))) if len(at) > 1 else np.inf
    middle = 0.5 * (at[1:] + at[:-1])
    begin = np.maximum(np.append(at[0] - reach / 2, middle), at - reach)
    end = np.minimum(np.append(middle, at[-1] + reach / 2), at + reach)
    first, last = np.searchsorted(t, begin), np.searchsorted(t, end)
    found = np.flatnonzero(last > first)
    total = np.cumsum(np.insert(values, 0, 0.0, axis=1), axis=1)
    averages = (total[:, last] - total[:, first]) / np.maximum(last - first, 1)
    return found, averages[:, found]


def _require(streams: Mapping[str, SampleColumns], name: str, folder: Path) -> SampleColumns:
    """Return the raw samples of a stream; raise `DataError` if the log has none."""
    if raw_topic(name) not in streams:
        raise DataError(f"the log holds no samples of topic {raw_topic(name)}", file=folder)
    return streams[raw_topic(name)]


def _increasing(table: SlipRigTable, run: str) -> tuple[SlipRigTable, tuple[str, ...]]:
    """Drop rows whose time is not later than all before, with a note on how many these are."""
    later = np.r_[True, np.diff(np.maximum.accumulate(table.t)) > 0]
    left_out = int(np.sum(~later))
    note = f"{run}: {left_out} samples are ignored, because their time does not increase"
    return table.select(later), (note,) * bool(left_out)
