# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab compare`: compare calibrations, curves or runs, and write the folder."""

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from model.metrics.difference import PathDifference, difference
from zebro_lab.calibration.curve_argument import EXPECTED_CURVE, is_curve
from zebro_lab.calibration.folder import SLIP_TOML
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.names import TRACK, shortest_distinct
from zebro_lab.files.picture_format import PictureFormat, in_every_format
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import ResultKind, require_replaceable, result_folder
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots.sheet import save
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.validation.compare.pictures import overlay
from zebro_lab.validation.compare.runs import compare_runs
from zebro_lab.validation.compare.slip_curves import compare_slip
from zebro_lab.validation.compare.values import Comparison, Quantity

SCHEMA = 1
TABLE, PICTURE = "comparison.csv", "comparison"
COMPARISON = ResultKind("comparison", "compare", (TABLE, *in_every_format(PICTURE)), SCHEMA)


@dataclass(frozen=True)
class Compared:
    """A finished comparison.

    Attributes:
        comparison: Quantities of the first and the second, with draws.
        differences: Difference of each quantity, the second minus the first.
    """

    comparison: Comparison
    differences: tuple[PathDifference, ...]

    @property
    def rows(self) -> list[tuple[Quantity, PathDifference]]:
        """Each quantity with its difference."""
        return list(zip(self.comparison.quantities, self.differences, strict=True))


def compare(
    first: Path, second: Path, *, out: Path, form: PictureFormat = "png", seed: int = 1
) -> Compared:
    """Compare two calibrations, a calibration and a curve, or two runs; write the folder.

    Args:
        first: Calibration folder, run folder, or a curve.
        second: Second of the same kind, or a curve beside a calibration.
        out: Folder to write.
        form: Format of the picture.
        seed: Seed of all random numbers.

    Raises:
        ZebroLabError: The two are of different kinds or the same, cannot be read, have no
            quantity in common, or the folder cannot be replaced.
        ModelError: A draw is not a finite number, or slip ratios cannot be converted.
    """
    require_replaceable(out, COMPARISON, inputs=(first, second))
    rng = np.random.default_rng(seed)
    one, other = shortest_distinct([first.absolute(), second.absolute()])
    if one == other:
        raise SettingsError(f"{first} is compared with itself; choose another folder as B")
    kinds = [_kind(path) for path in (first, second)]
    if kinds.count("run") == 1:
        raise SettingsError(
            f"{first} is a {kinds[0]} and {second} a {kinds[1]}; compare two of a kind, or a "
            "calibration and a curve"
        )
    comparer = compare_runs if "run" in kinds else compare_slip
    comparison = comparer(first, second, names=(one, other), rng=rng)
    differences = (difference(*each.draws, rng=rng) for each in comparison.quantities)
    done = Compared(comparison, tuple(differences))
    rows = [_row(*row) for row in done.rows]
    content = {
        "of": comparison.kind,
        "source": comparison.source,
        "settings": {"seed": seed, "names": list(comparison.names)},
        "quantities": rows,
        "notes": list(comparison.notes),
        **({"place": asdict(comparison.place)} if comparison.place is not None else {}),
        "inputs": file_hashes(comparison.files),
    }
    with result_folder(out, COMPARISON, content=content) as draft:
        table = pd.DataFrame(rows)
        table.to_csv(draft / TABLE, index=False, float_format="%.6g", lineterminator="\n")
        figure = overlay(comparison, simulated=is_simulated(comparison.source))
        save(figure, draft / f"{PICTURE}.{form}")
    return done


def _kind(path: Path) -> str:
    """Return "curve", "calibration" (it is or has a `slip.toml`) or "run" (it has a track).

    Raises:
        NotFound: The path is none of these.
    """
    if is_curve(path):
        return "curve"
    recover(path)
    if path.suffix.lower() == ".toml" or (path / SLIP_TOML).is_file():
        return "calibration"
    if (recover(path / TRACK) / TRACK_CSV).is_file():
        return "run"
    raise NotFound(
        f"{path} is no folder with {SLIP_TOML} or track/track.csv; choose "
        f"two folders that calibrate-slip wrote, or one and {EXPECTED_CURVE}, or two runs; two "
        "trajectories are compared by: zebro-lab validate REFERENCE ESTIMATE"
    )


def _row(quantity: Quantity, difference: PathDifference) -> dict[str, object]:
    """Return the row of a quantity in `comparison.csv`, by column."""
    row: dict[str, object] = {"quantity": quantity.name, "unit": quantity.unit}
    for which, name in enumerate(("first", "second")):
        median, low, high = quantity.quantiles(which)
        row |= {name: median, f"{name}_q05": low, f"{name}_q95": high}
    return row | {f"difference_{key}": value for key, value in asdict(difference).items()}
