# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab read-off`: curves by load, their coefficients, and the folder."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from model.arrays import Array
from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.load_levels import load_levels
from model.counted import counted
from model.errors import DomainError
from model.slip.definition import SlipDefinition, convert_slip
from model.slip.load_curves import LoadCurve, curves_by_load
from model.slip.magic_formula import peak_slip
from model.slip.read_off import ReadOff, read_off
from zebro_lab import plots
from zebro_lab.calibration.curve_argument import CurveTable, is_curve_table, read_curve_table
from zebro_lab.calibration.read_off.pictures import read_curves
from zebro_lab.calibration.read_off.request import ReadOffRequest
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import ResultKind, require_replaceable, result_folder
from zebro_lab.files.source_names import is_simulated

TABLE, PICTURE = "read-off.csv", "curves"
READ_OFF: Final = ResultKind("read-off", "read-off", (TABLE, *in_every_format(PICTURE)))
_FEWEST = 3  # points of a side of a curve, below which it is no side but noise about zero slip


@dataclass(frozen=True)
class ReadCurve:
    """A curve at one load, and what was read off it.

    Attributes:
        curve: The points, at positive slip and force.
        side: "driving" or "braking".
        found: Coefficients; None where the curve does not give them.
        reason: Why not; empty if it does.
    """

    curve: LoadCurve
    side: str
    found: ReadOff | None
    reason: str = ""

    def row(self) -> dict[str, object]:
        """Return the row of `read-off.csv`; NaN where nothing was found."""
        nan = float("nan")
        found = self.found or ReadOff(nan, nan, nan, nan, (nan,) * 4, nan)
        row: dict[str, object] = {
            "load_n": self.curve.load, "side": self.side, "points": len(self.curve.slip),
        }  # fmt: skip
        for name, error in zip("BCDE", found.errors, strict=True):
            row |= {name: getattr(found, name), f"{name}_error": error}
        peak = float(peak_slip(found.B, found.C, found.E)) if self.found else np.nan
        return row | {
            "peak_over_load": found.D / self.curve.load, "peak_slip": peak,
            "misfit_n": found.misfit, "problem": self.reason,
        }  # fmt: skip


@dataclass(frozen=True)
class ReadOffResult:
    """What was read off all curves.

    Attributes:
        curves: The curves by load, driving before braking.
        definition: Slip definition.
        source: Source of the data.
        notes: Notes on the data, one line each.
    """

    curves: tuple[ReadCurve, ...]
    definition: SlipDefinition
    source: str
    notes: tuple[str, ...]


def read_off_curves(request: ReadOffRequest) -> ReadOffResult:
    """Read B, C, D and E off the slip curve at each load, and write the folder.

    Points are the rows of a table of a curve, else the means of runs (the rows, if the data are one
    run).

    Raises:
        ZebroLabError: The data cannot be read, have no load, no curve gives coefficients, or the
            folder cannot be replaced.
        DomainError: Slip ratios cannot be converted.
    """
    require_replaceable(request.out, READ_OFF, inputs=request.data)
    points, levels = _points(request)
    curves = tuple(
        each
        for curve in curves_by_load(points.slip, points.load, points.traction, levels=levels)
        for each in _read_sides(curve)
    )
    if not any(each.found for each in curves):
        reasons = [f"at {each.curve.load:.4g} N: {each.reason}" for each in curves]
        raise DataError(reasons[0] if reasons else "has no curve of 3 points", file=points.files[0])
    result = ReadOffResult(curves, points.definition, points.source, points.notes)
    _write(request, result, points.files)
    return result


def _points(request: ReadOffRequest) -> tuple[CurveTable, Array | None]:
    """Read points in the definition that is asked for; of rig data also the loads that were set.

    The loads [N] are found from about 1000 block means, whose noise is less than that of samples.
    """
    if len(request.data) == 1 and is_curve_table(request.data[0]):
        table = read_curve_table(request.data[0], columns=request.columns)
        wanted = SlipDefinition(request.slip_definition or table.definition)
        slip = convert_slip(table.slip, table.definition, wanted)
        return replace(table, slip=slip, definition=wanted), None
    data = read_rig_data(
        request.data, columns=request.columns, slip_definition=request.slip_definition
    )
    samples, notes = data.samples, data.notes
    slip, load, force = samples.slip, samples.normal_force, samples.traction_force
    levels = load_levels(block_means(samples, max(1, len(samples) // 1000)))
    if samples.n_runs > 1:
        runs = samples.slices()
        slip, load, force = (_run_means(each, runs) for each in (slip, load, force))
        notes = (*notes, f"points are the means of {counted(samples.n_runs, 'run')}")
    return CurveTable(slip, load, force, samples.definition, data.source, data.files, notes), levels


def _run_means(values: Array, runs: list[slice]) -> Array:
    """Return the mean over each run, shape (n_runs,)."""
    return np.array([float(np.mean(values[run])) for run in runs])


def _read_sides(curve: LoadCurve) -> Iterator[ReadCurve]:
    """Yield what is read off the driving and the braking side.

    A side with fewer than `_FEWEST` points is left out. Each side begins at the origin, which is
    added where it is no point.
    """
    for side, half in (("driving", curve.driving()), ("braking", curve.braking())):
        if len(half.slip) < _FEWEST:
            continue
        part = half
        if half.slip[0] > 0:
            part = LoadCurve(half.load, np.append(0.0, half.slip), np.append(0.0, half.force))
        try:
            yield ReadCurve(part, side, read_off(part.slip, part.force))
        except DomainError as error:
            yield ReadCurve(part, side, None, str(error))


def _write(request: ReadOffRequest, result: ReadOffResult, files: tuple[Path, ...]) -> None:
    """Write the result folder: table, picture and manifest."""
    rows = [each.row() for each in result.curves]
    content = {
        "source": result.source,
        "settings": {"slip_definition": str(result.definition)},
        "notes": list(result.notes),
        "curves": rows,
        "inputs": file_hashes(files),
    }
    with result_folder(request.out, READ_OFF, content=content) as draft:
        table = pd.DataFrame(rows)
        table.to_csv(draft / TABLE, index=False, float_format="%.6g", lineterminator="\n")
        shown = [(each.curve, each.side, each.found) for each in result.curves]
        figure = read_curves(
            shown, definition=str(result.definition), simulated=is_simulated(result.source)
        )
        plots.save(figure, draft / f"{PICTURE}.{request.form}")
