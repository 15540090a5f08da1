# SPDX-License-Identifier: MIT
"""Compare two calibrations: slip curves at common loads, and posteriors after walks."""

from pathlib import Path

import numpy as np

from model.arrays import Array
from model.bayes.walks.posterior import WalkPosterior
from model.bayes.walks.prior import NAMES, UNITS
from model.slip.curve import SlipCurve
from zebro_lab.calibration.slip_argument import NamedSlip, parse_slip
from zebro_lab.calibration.slip_draws import law_draws
from zebro_lab.files.errors import DataError
from zebro_lab.files.units import shown_unit
from zebro_lab.validation.compare.values import Comparison, Curve, Quantity

DRAWS = 1000
SLIPS = 200  # points of a drawn curve


def compare_calibrations(
    first: Path, second: Path, *, names: tuple[str, str], rng: np.random.Generator
) -> Comparison:
    """Compare two calibrations: peak traction and slope at up to 3 loads; legs and floor if fitted.

    Args:
        first: A calibration folder.
        second: Another calibration folder.
        names: Names to show for the first and the second.
        rng: Random number generator.

    Raises:
        ZebroLabError: A calibration cannot be read or is assumed friction, slip definitions differ,
            or the tested loads do not overlap.
    """
    slips = (parse_slip(str(first)), parse_slip(str(second)))
    curves = tuple(_curve_of(slip) for slip in slips)
    _require_one_definition(curves, second)
    drawn = [
        law_draws(slip, curve, DRAWS, rng=rng) for slip, curve in zip(slips, curves, strict=True)
    ]
    limit = min(curve.slip_range[1] for curve in curves)
    quantities, shown = [], []
    for load in _common_loads(curves, second):
        pairs = [_features(c, v, load, limit) for c, v in zip(curves, drawn, strict=True)]
        for i, name in enumerate(("largest traction over load", "initial slope over load")):
            quantities.append(
                Quantity(f"{name} at {load:.3g} N", "", (pairs[0][i] / load, pairs[1][i] / load))
            )
        shown.append(_band(curves, drawn, load, limit))
    walks, notes = _walk_quantities(slips, rng)
    return Comparison(
        kind="calibrations",
        names=names,
        quantities=(*quantities, *walks),
        source=", ".join(sorted({slip.source for slip in slips})),
        files=tuple(dict.fromkeys(file for slip in slips for file in slip.files)),
        notes=(*(note for slip in slips for note in slip.notes), *notes),
        curves=tuple(shown),
        definition=str(curves[0].definition),
        doubted=(bool(slips[0].doubts), bool(slips[1].doubts)),
    )


def _curve_of(slip: NamedSlip) -> SlipCurve:
    if not isinstance(slip.law, SlipCurve):
        raise DataError("is an assumed friction, not a calibration", file=Path(slip.text))
    return slip.law


def _require_one_definition(curves: tuple[SlipCurve, ...], second: Path) -> None:
    one, other = (curve.definition for curve in curves)
    if one is not other:
        raise DataError(
            f"was fitted to '{other}' slip, the first to '{one}' slip: no axis is "
            f"common to both; calibrate again with --slip-definition {one}",
            file=second,
        )


def _common_loads(curves: tuple[SlipCurve, ...], second: Path) -> Array:
    """Return lowest, middle and highest load [N] of the range that both were tested in.

    It is one load if the range has no width; `DataError` is raised without a common range.
    """
    low = max(curve.load_range[0] for curve in curves)
    high = min(curve.load_range[1] for curve in curves)
    if low > high:
        ranges = [f"{a:.3g} to {b:.3g} N" for a, b in (curve.load_range for curve in curves)]
        raise DataError(
            f"was tested at {ranges[1]}, the first at {ranges[0]}: no load is common to both; test "
            "one again at loads of the other",
            file=second,
        )
    return np.unique(np.linspace(low, high, 3))


def _features(curve: SlipCurve, values: Array, load: float, limit: float) -> tuple[Array, Array]:
    """Compute largest traction up to slip `limit`, and slope at zero slip [N], each (n,)."""
    columns, n = values.T, len(values)
    peak = np.minimum(curve.law.peak_slip(load, columns), limit)
    largest = curve.law.force(peak, load, columns)
    slope = curve.law.slip_derivative(0.0, load, columns)
    return np.broadcast_to(largest, n), np.broadcast_to(slope, n)


def _band(curves: tuple[SlipCurve, ...], drawn: list[Array], load: float, limit: float) -> Curve:
    slip = limit * np.linspace(0.0, 1.0, SLIPS) ** 2  # peaks are narrow and near zero
    bands = [
        np.quantile(
            np.broadcast_to(
                curve.law.force(slip, load, values.T[:, :, None]), (len(values), SLIPS)
            ),
            [0.05, 0.5, 0.95],
            axis=0,
        )
        for curve, values in zip(curves, drawn, strict=True)
    ]
    return Curve(slip, float(load), np.stack(bands))


def _walk_quantities(
    slips: tuple[NamedSlip, ...], rng: np.random.Generator
) -> tuple[list[Quantity], list[str]]:
    """Return the parameters of legs and floor that walks constrain in either calibration.

    Without a fit of walks in both, the list is empty; there is a note if only one has a fit,
    and a warning for a fit that is not reliable.
    """
    one, other = (slip.walks for slip in slips)
    if one is None or other is None:
        return [], [
            "legs and floor are not compared: only one was fitted to walks"
        ] if one or other else []
    posteriors = (one.posterior, other.posterior)
    contractions = [posterior.contractions() for posterior in posteriors]
    first, second = (_drawn(posterior, rng) for posterior in posteriors)
    quantities = []
    for i, (name, unit) in enumerate(zip(NAMES, UNITS, strict=True)):
        if not any(each[i].informed for each in contractions):
            continue
        scale, shown = shown_unit(unit)
        draws = (scale * first[:, i], scale * second[:, i])
        quantities.append(Quantity(name.replace("_", " "), shown, draws))
    return quantities, [*one.doubts, *other.doubts]


def _drawn(posterior: WalkPosterior, rng: np.random.Generator) -> Array:
    chosen = rng.choice(len(posterior.weight), DRAWS, p=posterior.weight)
    return posterior.with_wrong_legs()[chosen]
