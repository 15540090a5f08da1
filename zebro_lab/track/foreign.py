# SPDX-License-Identifier: MIT
"""Import a path tracked by another program, from a table or a TUM file."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from model.slip.law import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_text
from zebro_lab.tables.mapped_columns import MappedColumns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.track.file import TrackFile, track_of_table, tum_lines

_COVARIANCE: Final = {
    "cov_xx": "m^2", "cov_xy": "m^2", "cov_xyaw": "m rad", "cov_yy": "m^2", "cov_yyaw": "m rad",
    "cov_yawyaw": "rad^2",
}  # fmt: skip
TRACK_UNITS: Final[Mapping[str, str]] = {
    "t_s": "s", "t_sigma": "s", "x_m": "m", "y_m": "m", "yaw_rad": "rad", **_COVARIANCE, "z_m": "m",
}  # fmt: skip
_SHORT: Final = {"t_s": "t", "x_m": "x", "y_m": "y", "z_m": "z", "yaw_rad": "yaw"}
_NEEDED: Final = ("t_s", "x_m", "y_m")
TUM_SUFFIXES: Final = (".tum", ".txt")
TUM_COLUMNS: Final = ("t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")


@dataclass(frozen=True)
class ForeignTrack:
    """Path tracked by another program, validated.

    Attributes:
        track: Poses and their covariance.
        more: Known further columns of `track.csv`, `t_sigma` [s] and `z_m` [m], shape (n,) each.
        with_covariance: Whether the covariance is known.
        files: Every file read: the table and, if there is one, its `columns.toml`.
    """

    track: TrackFile
    more: Mapping[str, Array] = field(default_factory=dict)
    with_covariance: bool = False
    files: tuple[Path, ...] = ()

    @property
    def columns(self) -> Mapping[str, Sequence[float]]:
        """Known columns of `track.csv` by name, in the order of `TRACK_UNITS`."""
        poses = self.track.poses
        x, y = poses.position.T.tolist()
        known: dict[str, Sequence[float]] = {"t_s": poses.t.tolist(), "x_m": x, "y_m": y}
        if poses.has_yaw:
            known["yaw_rad"] = poses.yaw.tolist()
        if self.with_covariance:
            upper = zip(_COVARIANCE, zip(*np.triu_indices(3), strict=True), strict=True)
            known |= {name: self.track.covariance[:, i, j].tolist() for name, (i, j) in upper}
        known |= {name: column.tolist() for name, column in self.more.items()}
        return {name: known[name] for name in TRACK_UNITS if name in known}

    @property
    def tum(self) -> Sequence[str]:
        """Lines of `track.tum`; see `tum_lines`."""
        return tum_lines(self.track.poses).splitlines()


def is_tum(path: Path) -> bool:
    """Return whether a file name ends in `.tum` or `.txt`, as TUM trajectories do."""
    return path.suffix.lower() in TUM_SUFFIXES


def track_of_foreign_table(table: RawTable, mapping: MappedColumns, *, zero: float) -> ForeignTrack:
    """Convert a path in a table of another program to SI and validate it.

    Args:
        table: The table.
        mapping: Header, unit and sign of each column of `TRACK_UNITS`; the headers `t`, `x`, `y`,
            `z` and `yaw` are recognised without an entry.
        zero: Time of the table at which the run began [s]; subtracted from all times.

    Raises:
        DataError: Time, x or y is missing, a cell holds no finite number, time does not increase, a
            covariance has a negative eigenvalue, or there are fewer than three poses; names the
            cell.
    """
    import pandas as pd

    columns = {}
    for name in TRACK_UNITS:
        seen = _seen_as(table, mapping, name)
        if name in _NEEDED or seen.has(table, name):
            values = seen.numbers(
                table, name, what=f"{name} of the track", advice="leave such poses out"
            )
            columns[name] = values - zero if name == "t_s" else values
    si = {name: pd.Series(values) for name, values in columns.items()}
    source = mapping.source or table.source
    checked = RawTable(table.path, si, source=source, notes=table.notes,
                       header_line=table.header_line)  # fmt: skip
    more = {name: columns[name] for name in ("t_sigma", "z_m") if name in columns}
    files = (table.path, *([mapping.file] if mapping.file else []))
    return ForeignTrack(track_of_table(checked), more, set(_COVARIANCE) <= set(columns), files)


def read_tum(path: Path) -> RawTable:
    """Read a TUM trajectory, `t x y z qx qy qz qw`, as columns t_s, x_m, y_m, yaw_rad and z_m.

    Yaw is unwrapped, roll and pitch are dropped. Empty lines and those with `#` are skipped.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is no text or empty, a line has not eight finite numbers, or a
            quaternion's length differs from 1 by more than 0.05; names the row.
    """
    import pandas as pd

    # Not splitlines: it also splits at characters that editors do not count as line ends.
    lines = re.split(r"\r\n|\n|\r", read_text(path))
    numbered = [(i, line) for i, line in enumerate(lines, start=1)
                if line.strip() and not line.startswith("#")]  # fmt: skip
    if not numbered:
        raise DataError("has no pose; expected lines of t x y z qx qy qz qw", file=path)
    rows = np.array([_pose(path, row, *line) for row, line in enumerate(numbered, start=1)])
    t, x, y, z, qx, qy, qz, qw = rows.T
    yaw = np.unwrap(np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2)))
    columns = {"t_s": t, "x_m": x, "y_m": y, "yaw_rad": yaw, "z_m": z}
    return RawTable(path, {name: pd.Series(values) for name, values in columns.items()})


def _seen_as(table: RawTable, mapping: MappedColumns, name: str) -> MappedColumns:
    """Map the canonical column `name` to its short header (`t`, `x`, …) if it is not in the table.

    A header named in a `columns.toml` is kept.
    """
    short = _SHORT.get(name)
    if short is None or mapping.has(table, name) or mapping.mapped[name].name != name:
        return mapping
    return mapping.called(name, short)


def _pose(path: Path, row: int, line: int, text: str) -> list[float]:
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError as error:
        raise DataError(f"{error}; expected 8 numbers", file=path, row=row, line=line) from error
    if len(numbers) != len(TUM_COLUMNS) or not np.isfinite(numbers).all():
        raise DataError(
            f"found {len(numbers)} numbers; expected {len(TUM_COLUMNS)} finite ones: "
            f"{' '.join(TUM_COLUMNS)}",
            file=path, row=row, line=line,
        )  # fmt: skip
    norm = float(np.linalg.norm(numbers[4:]))
    if abs(norm - 1) > 0.05:
        raise DataError(
            f"quaternion length {norm:.4g}; expected 0.95 to 1.05", file=path, row=row, line=line
        )
    return numbers
