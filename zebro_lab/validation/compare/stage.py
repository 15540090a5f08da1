# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab compare`: compare calibrations, curves or runs, and write the folder."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from model.metrics.difference import Difference
from zebro_lab.calibration.curve_argument import EXPECTED_CURVE, is_curve
from zebro_lab.calibration.folder import SLIP_TOML
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.names import shortest_distinct
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.provenance import file_hash, file_hashes
from zebro_lab.files.replacement import settle
from zebro_lab.files.result_folder import ResultKind, require_replaceable, result_folder
from zebro_lab.files.source_names import is_simulated
from zebro_lab.validation.compare.calibrations import compare_calibrations
from zebro_lab.validation.compare.curves import compare_with_curve
from zebro_lab.validation.compare.request import CompareRequest
from zebro_lab.validation.compare.runs import compare_runs, is_walked
from zebro_lab.validation.compare.values import Comparison, Quantity

SCHEMA = 1
TABLE, PICTURE = "comparison.csv", "comparison"
COMPARISON = ResultKind("comparison", "compare", (TABLE, *in_every_format(PICTURE)), SCHEMA)


class Comparer(Protocol):
    """What compares two things of the kinds that it is for."""

    def __call__(
        self, first: Path, second: Path, *, names: tuple[str, str], rng: np.random.Generator
    ) -> Comparison:
        """Compare two paths; arguments as of `compare_calibrations`."""
        ...


@dataclass(frozen=True)
class Compared:
    """A finished comparison.

    Attributes:
        comparison: Quantities of the first and the second, with draws.
        differences: Difference of each quantity, the second minus the first.
    """

    comparison: Comparison
    differences: tuple[Difference, ...]


def compare(request: CompareRequest) -> Compared:
    """Compare two calibrations, a calibration and a curve, or two runs; write the folder.

    Raises:
        ZebroLabError: The two are of different kinds, the same or copies, cannot be read, have no
            quantity in common, or the folder cannot be replaced.
        ModelError: A draw is not a finite number, or slip ratios cannot be converted.
    """
    require_replaceable(request.out, COMPARISON, inputs=(request.first, request.second))
    rng = np.random.default_rng(request.seed)
    names = _names(request.first, request.second)
    comparison = _comparer(request)(request.first, request.second, names=names, rng=rng)
    _require_different(request, comparison)
    done = Compared(comparison, tuple(each.difference(rng) for each in comparison.quantities))
    _write(request, done)
    return done


def _comparer(request: CompareRequest) -> Comparer:
    """Return the function that compares the two by their kinds."""
    kind, other = (_kind(path) for path in (request.first, request.second))
    kinds = {kind, other}
    if kinds == {"run"}:
        return compare_runs
    if kinds == {"calibration"}:
        return compare_calibrations
    if "run" not in kinds:
        return compare_with_curve
    raise SettingsError(
        f"{request.first} is a {kind} and {request.second} a {other}; compare two of a kind, or a "
        "calibration and a curve"
    )


def _kind(path: Path) -> str:
    if is_curve(path):
        return "curve"
    settle(path)
    if path.is_file() and path.suffix.lower() != ".toml":
        raise SettingsError(
            f"{path} is a file and neither a slip.toml nor a table; name a run by its folder, or "
            "compare two trajectories with: zebro-lab validate REFERENCE ESTIMATE"
        )
    if path.is_file() or (path / SLIP_TOML).is_file():
        return "calibration"
    if is_walked(path):
        return "run"
    raise NotFound(
        f"{path} is no folder with {SLIP_TOML}, track/track.csv or prediction/draws.npz; choose "
        f"two folders that calibrate-slip wrote, or one and {EXPECTED_CURVE}, or two runs"
    )


def _names(first: Path, second: Path) -> tuple[str, str]:
    """Return the shortest distinct last parts of two paths; raise if the paths are equal."""
    one, other = shortest_distinct([first.absolute(), second.absolute()])
    if one == other:
        raise SettingsError(f"{first} is compared with itself; choose another folder as B")
    return one, other


def _require_different(request: CompareRequest, comparison: Comparison) -> None:
    """Raise `SettingsError` where the files that were read of both have the same content."""
    if comparison.place is not None:
        return
    read = []
    for path in (request.first, request.second):
        folder = path if path.is_dir() else path.parent
        files = [file for file in comparison.files if folder in file.parents]
        read.append({file_hash(file) for file in files})
    if read[0] == read[1]:
        raise SettingsError(
            f"{request.second} is a copy of {request.first}, with the same content; choose another "
            "folder as B"
        )


def _write(request: CompareRequest, done: Compared) -> None:
    import pandas as pd

    from zebro_lab.plots import save
    from zebro_lab.validation.compare.pictures import overlay

    compared = done.comparison
    rows = [
        _row(quantity, difference)
        for quantity, difference in zip(compared.quantities, done.differences, strict=True)
    ]
    content = {
        "of": compared.kind,
        "source": compared.source,
        "settings": {"seed": request.seed, "names": list(compared.names)},
        "quantities": rows,
        "notes": list(compared.notes),
        **({"place": asdict(compared.place)} if compared.place is not None else {}),
        "inputs": file_hashes(compared.files),
    }
    with result_folder(request.out, COMPARISON, content=content) as draft:
        pd.DataFrame(rows).to_csv(
            draft / TABLE, index=False, float_format="%.6g", lineterminator="\n"
        )
        figure = overlay(compared, done.differences, simulated=is_simulated(compared.source))
        save(figure, draft / f"{PICTURE}.{request.form}")


def _row(quantity: Quantity, difference: Difference) -> dict[str, object]:
    row: dict[str, object] = {"quantity": quantity.name, "unit": quantity.unit}
    for which, name in enumerate(("first", "second")):
        median, low, high = quantity.quantiles(which)
        row |= {name: median, f"{name}_q05": low, f"{name}_q95": high}
    return row | {f"difference_{key}": value for key, value in asdict(difference).items()}
