# SPDX-License-Identifier: MIT
"""Readers of trajectories of other programs: TUM, KITTI, EuRoC and tables, by their content."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.faults.fuzzed_readers.reader import Reader, text_check
from benchmarks.faults.hostile_inputs import TEXTS, Make, changed_bytes, odd_value, pick
from zebro_lab.track.trajectory.file import read_trajectory
from zebro_lab.track.trajectory.request import TrajectoryRequest

_ROWS = 12
_EUROC = (
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []"
)


def of_trajectories() -> Mapping[str, Reader]:
    """Return readers of trajectories."""
    tum = [f"{1e9 + 0.1 * k:.4f} {0.1 * k:.3f} 0 0 0 0 0 1" for k in range(_ROWS)]
    kitti = [f"1 0 0 {0.1 * k:.3f} 0 1 0 0 0 0 1 0" for k in range(_ROWS)]
    euroc = [f"{10**18 + 5 * 10**6 * k},{0.1 * k:.3f},0,0,1,0,0,0" for k in range(_ROWS)]
    return {
        "trajectory: TUM": Reader("x.txt", _read, lines(tum, " "), text_check),
        "trajectory: KITTI": Reader("x.txt", _read, lines(kitti, " "), text_check),
        "trajectory: EuRoC": Reader("x.csv", _read, lines([_EUROC, *euroc], ","), text_check),
    }


def _read(file: Path) -> object:
    return read_trajectory(file, TrajectoryRequest())


def lines(rows: Sequence[str], separator: str) -> Make:
    """Make texts with odd words, lines, separators and ends of lines; a fifth has changed bytes.

    Args:
        rows: Lines of a valid file.
        separator: Separator of their words.
    """

    def make(rng: np.random.Generator) -> bytes:
        changed = [row.split(separator) for row in rows]
        for _ in range(int(rng.integers(0, 4))):
            _spoil(changed, rng)
        between = separator if rng.random() < 0.9 else pick(rng, ("\t", ", ", ";", "  "))
        text = pick(rng, ("\n", "\n", "\r\n", "\r")).join(between.join(row) for row in changed)
        encoding = pick(rng, ("utf-8", "utf-8", "utf-8-sig", "utf-16"))
        data = text.encode(encoding, errors="replace")
        return changed_bytes(data, rng) if rng.random() < 0.2 else data

    return make


def _spoil(rows: list[list[str]], rng: np.random.Generator) -> None:
    kind, at = int(rng.integers(7)), int(rng.integers(len(rows)))
    row = rows[at]
    if kind < 2 and row:
        row[int(rng.integers(len(row)))] = str(odd_value(rng, 3))
    elif kind == 2:
        row.append(str(pick(rng, TEXTS)))
    elif kind == 3:
        del row[int(rng.integers(len(row) + 1)) :]
    elif kind == 4:
        rows.insert(at, list(pick(rng, rows)))
    elif kind == 5 and len(rows) > 1:
        del rows[at]
    else:
        rows.insert(at, [pick(rng, ("#", "%", "", "# t x y", "timestamp"))])
