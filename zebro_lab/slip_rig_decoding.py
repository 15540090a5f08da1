# SPDX-License-Identifier: MIT
"""From raw samples of a recorded slip rig to the columns that a calibration takes."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from model.slip.law import Array
from rig.errors import RigError
from rig.slip_rig.decode import decode_board, decode_forces, decode_speeds
from rig.slip_rig.profile import BoardProfile, DriveProfile, LoadCellProfile, load_rig_profile
from zebro_lab.clock_watch import sample_times
from zebro_lab.errors import DataError
from zebro_lab.raw_log import RawStream, raw_topic
from zebro_lab.run_folder import profile_file
from zebro_lab.slip_rig_log import SlipRigTable

RIG = "rig"
"""Name under which a run keeps the profile of its rig."""
_PIECE = 4096  # samples made into objects at a time


def derive_table(
    folder: Path, streams: Mapping[str, RawStream], *, zero: Mapping[str, float]
) -> tuple[SlipRigTable, tuple[str, ...]]:
    """Compute speeds and forces of a recorded run from what its devices sent.

    Where drives and load cell are apart, the speeds are interpolated to the instants of the forces,
    and what lies outside the speeds is left out: nobody knows the slip there.

    Args:
        folder: The run folder, which keeps the profile.
        streams: Raw streams of its log, by topic.
        zero: What the unloaded load cell read, `zero_normal` and `zero_traction`, to be
            subtracted; 0 where absent [N].

    Returns:
        The samples, and notes on what was left out.

    Raises:
        DataError: A stream is missing or without a complete sample, or the profile cannot be
            followed.
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
            raise DataError("has neither a board nor drives and load cell", file=file)
    except RigError as error:
        raise DataError(str(error), file=folder) from error
    if table.shape[1] == 0:
        raise DataError("its log holds no force between two speeds of each disc", file=folder)
    table[3] -= zero.get("zero_normal", 0.0)
    table[4] -= zero.get("zero_traction", 0.0)
    return _increasing(table)


def _of_board(profile: BoardProfile, board: RawStream) -> Array:
    columns = []
    for piece in pieces(board):
        forces, speeds = decode_board(profile, piece.samples())
        columns.append((speeds.leg, speeds.ground, forces.normal, forces.traction))
    return np.vstack([sample_times(board), np.hstack(columns)])


def _of_two(
    drives: DriveProfile, cell: LoadCellProfile, speeds: RawStream, forces: RawStream
) -> Array:
    t = sample_times(forces)
    decoded = [decode_forces(cell, piece.samples()) for piece in pieces(forces)]
    disc = decode_speeds(drives.leg, drives.ground, speeds.samples())
    inside = (t >= disc.time[0]) & (t <= disc.time[-1])
    return np.vstack([
        t,
        np.interp(t, disc.time, disc.leg),
        np.interp(t, disc.time, disc.ground),
        np.concatenate([part.normal for part in decoded]),
        np.concatenate([part.traction for part in decoded]),
    ])[:, inside]  # fmt: skip


def _require(streams: Mapping[str, RawStream], name: str, folder: Path) -> RawStream:
    if raw_topic(name) not in streams:
        raise DataError(f"its log holds no samples on {raw_topic(name)}", file=folder)
    return streams[raw_topic(name)]


def pieces(stream: RawStream) -> list[RawStream]:
    """Cut a stream so that a few of its samples at a time need be made into objects."""
    return [
        RawStream(*(column[first : first + _PIECE] for column in vars(stream).values()))
        for first in range(0, len(stream), _PIECE)
    ]


def _increasing(table: Array) -> tuple[SlipRigTable, tuple[str, ...]]:
    later = np.r_[True, np.diff(np.maximum.accumulate(table[0])) > 0]
    left_out = int(np.sum(~later))
    notes = (f"{left_out} samples left out whose time does not increase",) if left_out else ()
    return SlipRigTable(*table[:, later]), notes
