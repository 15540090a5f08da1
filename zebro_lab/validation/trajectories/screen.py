# SPDX-License-Identifier: MIT
"""Terminal output of `validate REFERENCE ESTIMATE`: the errors in plane and space."""

import math
from collections.abc import Iterator
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.messages import plain
from zebro_lab.terminal.tables import plain_table
from zebro_lab.validation.trajectories.folder import metrics
from zebro_lab.validation.trajectories.pair import JudgedPair

_NAMES = {
    "poses": "matched poses",
    "length_m": "length of the reference",
    "scale": "scale that was corrected",
    "ate_m": "absolute error (ATE), rms",
    "ate_mean_m": "ATE, mean",
    "ate_median_m": "ATE, median",
    "ate_largest_m": "ATE, largest",
    "ate_aligned_m": "aligned ATE, rms",
    "ate_aligned_mean_m": "aligned ATE, mean",
    "ate_aligned_median_m": "aligned ATE, median",
    "ate_aligned_largest_m": "aligned ATE, largest",
    "alignment_deg": "turn of the alignment",
    "rotation_rms_deg": "error of rotation, rms",
}


def print_pair(console: Console, judged: JudgedPair, out: Path) -> None:
    """Print warnings, errors and notes of a trajectory, and the output folder.

    Args:
        console: Console to print to.
        judged: The errors.
        out: Folder that was written.
    """
    if is_simulated(judged.source):
        console.print(plain(f"SIMULATED: {judged.source}"))
    warnings = [note for note in judged.notes if note.startswith("WARNING")]
    for note in warnings:
        console.print(plain(note))
    console.print(_table(judged))
    for note in judged.notes:
        if note not in warnings:
            console.print(plain(note))
    console.print(Text(f"\nwritten to {out}"))


def _table(judged: JudgedPair) -> Table:
    rows = [metrics(row) for row in judged.rows]
    table = plain_table(judged.title, ("", "unit"), [row.where for row in judged.rows])
    for name, unit, values in _lines(rows):
        if name == _NAMES["scale"] and all(value == 1 for value in values):
            continue
        shown = ["" if math.isnan(value) else f"{value:.6g}" for value in values]
        table.add_row(name, unit, *shown)
    return table


def _lines(rows: list[dict[str, float]]) -> Iterator[tuple[str, str, list[float]]]:
    """Yield name, unit and values of each line of the table."""
    for key in rows[0]:
        values = [row[key] for row in rows]
        what, _, unit = key.rpartition("_")
        if key in ("poses", "scale"):
            yield _NAMES[key], "", values
        elif unit in ("m", "deg"):
            over = what.removeprefix("rpe_").removesuffix("m")
            pairs = "consecutive poses" if over == "step" else f"over {over} m"
            yield _NAMES.get(key, f"relative error (RPE), {pairs}, rms"), unit, values
