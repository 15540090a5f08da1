# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab compare`: compare two calibrations or two runs, write the folder."""

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from model.metrics.difference import Difference
from zebro_lab.calibration.folder import SLIP_TOML
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.replacement import settle
from zebro_lab.files.result_folder import ResultKind, require_replaceable, result_folder
from zebro_lab.validation.compare.calibrations import compare_calibrations
from zebro_lab.validation.compare.request import CompareRequest
from zebro_lab.validation.compare.runs import compare_runs, is_walked
from zebro_lab.validation.compare.values import Comparison

SCHEMA = 1
TABLE, PICTURE = "comparison.csv", "comparison.png"
COMPARISON = ResultKind("comparison", "compare", (TABLE, PICTURE), SCHEMA)


@dataclass(frozen=True)
class Compared:
    """A finished comparison.

    Attributes:
        comparison: The quantities of both.
        differences: Difference of each quantity, the second minus the first.
    """

    comparison: Comparison
    differences: tuple[Difference, ...]


def compare(request: CompareRequest) -> Compared:
    """Compare two calibrations or two runs and write the comparison folder.

    Raises:
        ZebroLabError: The two are of different kinds, cannot be read, or have no quantity in
            common.
    """
    require_replaceable(request.out, COMPARISON, inputs=(request.first, request.second))
    rng = np.random.default_rng(request.seed)
    names = _names(request.first, request.second)
    kinds = [_kind(path) for path in (request.first, request.second)]
    if kinds[0] != kinds[1]:
        raise SettingsError(
            f"{request.first} is a {kinds[0]} and {request.second} a {kinds[1]}; compare two of a "
            "kind"
        )
    by_kind = compare_calibrations if kinds[0] == "calibration" else compare_runs
    comparison = by_kind(request.first, request.second, names=names, rng=rng)
    done = Compared(comparison, tuple(each.difference(rng) for each in comparison.quantities))
    _write(request, done)
    return done


def _kind(path: Path) -> str:
    settle(path)
    if path.is_file() or (path / SLIP_TOML).is_file():
        return "calibration"
    if is_walked(path):
        return "run"
    raise NotFound(
        f"{path} holds no {SLIP_TOML}, track/ or prediction/ with draws; name two folders that "
        "calibrate-slip wrote, or two runs"
    )


def _names(first: Path, second: Path) -> tuple[str, str]:
    """Return the shortest distinct names: the last parts of their paths."""
    parts = [path.absolute().parts for path in (first, second)]
    for depth in range(1, max(len(each) for each in parts) + 1):
        one, other = (str(Path(*each[-depth:])) for each in parts)
        if one != other:
            return one, other
    raise SettingsError(f"{first} is compared with itself; name another")


def _write(request: CompareRequest, done: Compared) -> None:
    import pandas as pd

    from zebro_lab.plots import save
    from zebro_lab.validation.compare.pictures import overlay

    compared = done.comparison
    content = {
        "of": compared.kind,
        "source": compared.source,
        "settings": {"seed": request.seed, "names": list(compared.names)},
        "quantities": [_row(done, i) for i in range(len(done.differences))],
        "notes": list(compared.notes),
        "inputs": file_hashes(compared.files),
    }
    with result_folder(request.out, COMPARISON, content=content) as draft:
        pd.DataFrame([_row(done, i) for i in range(len(done.differences))]).to_csv(
            draft / TABLE, index=False, float_format="%.6g", lineterminator="\n"
        )
        figure = overlay(compared, done.differences, simulated="sim:" in compared.source)
        save(figure, draft / PICTURE)


def _row(done: Compared, i: int) -> dict[str, object]:
    quantity, apart = done.comparison.quantities[i], done.differences[i]
    row: dict[str, object] = {"quantity": quantity.name, "unit": quantity.unit}
    for which, name in enumerate(("first", "second")):
        median, low, high = quantity.quantiles(which)
        row |= {name: median, f"{name}_q05": low, f"{name}_q95": high}
    told = {f"difference_{key}": value for key, value in asdict(apart).items()}
    return row | told
