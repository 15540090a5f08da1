# SPDX-License-Identifier: MIT
"""Compare a calibration with a slip curve: the thesis's, an assumed one, or one of a table."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

import numpy as np

from model.arrays import Array
from model.slip.curve import SlipCurve
from model.slip.curve_band import CurveBand, Farthest, farthest, simultaneous_band
from model.slip.definition import SlipDefinition
from zebro_lab.calibration.curve_argument import GivenCurve, is_curve, parse_curve
from zebro_lab.calibration.fitted_blocks import FittedBlocks, read_fitted_blocks
from zebro_lab.calibration.folder import read_slip_file
from zebro_lab.calibration.slip_argument import NamedSlip, parse_slip
from zebro_lab.calibration.slip_draws import law_draws
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.validation.compare.values import Comparison, Curve, Place, Quantity

_T = TypeVar("_T")
DRAWS: Final = 1000
BAND: Final = "band of 90 % of whole curves"
_SLIPS = 160  # points of each half of a drawn curve
_PEAK_SLIPS = 4000  # points among which the largest force of a given curve is looked for
_FIRST = 0.03  # root of the first slip over the largest: at zero slip curves have no difference
_SIDE = 0.05  # of the farther side: reach from which a side was tested
_NEAR = 0.1  # relative difference of loads up to which a block is drawn at a load
_SAME = 0.02  # relative difference of a load from the tested range that is taken for inside


@dataclass(frozen=True)
class _Fitted:
    """The calibration of a comparison, with draws of its curve at the loads and slips compared."""

    slip: NamedSlip
    curve: SlipCurve
    values: Array
    blocks: FittedBlocks | None

    @property
    def definition(self) -> SlipDefinition:
        return self.curve.definition

    @property
    def limit(self) -> float:
        """Largest tested slip, of the side that was tested farther [-]."""
        return max(map(abs, self.curve.slip_range))

    def forces(self, slip: Array, loads: Array) -> Array:
        """Compute the force of each draw, shape (draws, loads, slips) [N]."""
        columns = self.values.T[:, :, None, None]
        force = self.curve.law.force(slip, loads[:, None], columns)
        return np.broadcast_to(force, (len(self.values), len(loads), len(slip)))


def compare_with_curve(
    first: Path, second: Path, *, names: tuple[str, str], rng: np.random.Generator
) -> Comparison:
    """Compare a calibration with a slip curve that has no uncertainty, given first or second.

    At each load, those of the curve if it has loads, else those that were tested: peak slip and
    peak force within the tested slips, slope at zero slip, and the force where the two differ most.
    The whole curve is judged by a band that holds 90 % of whole drawn curves.

    Args:
        first: A calibration folder, or the curve.
        second: The other.
        names: Names to show for the first and the second.
        rng: Random number generator.

    Raises:
        ZebroLabError: The calibration or the curve cannot be read, neither is a calibration, or
            they have no load or slip in common.
    """
    curve_first = is_curve(first)
    if curve_first and is_curve(second):
        raise SettingsError(
            f"neither {first} nor {second} is a calibration; name the folder of one as A or B"
        )
    calibration, other = (second, first) if curve_first else (first, second)
    fitted, given = _fitted(calibration, rng), parse_curve(other)
    loads = _loads(fitted, given, calibration)
    slip = _slips(fitted.curve)
    force = np.stack([given.force(slip, load, fitted.definition) for load in loads])
    if not np.isfinite(force).any():
        low, high = fitted.curve.slip_range
        raise DataError(
            f"{given.text} has no point at a tested slip ratio, {low:.3g} to {high:.3g}"
        )
    forces = fitted.forces(slip, loads)
    band = simultaneous_band(forces)
    place = farthest(band, force)
    order = (1, 0) if curve_first else (0, 1)
    quantities = [
        _ordered(name, unit, pair, order)
        for name, unit, pair in _quantities(fitted, given, loads, forces, force, slip, band)
    ]
    sources = dict.fromkeys(s for s in (fitted.slip.source, given.source) if s)
    return Comparison(
        kind="calibration and curve",
        names=names,
        quantities=tuple(quantities),
        source=", ".join(sources),
        files=(*fitted.slip.files, *given.files),
        notes=(*fitted.slip.notes, *given.notes, *given.said(fitted.definition),
               *_words(names, order, place, loads, slip, force)),
        curves=tuple(
            _drawn(fitted, band, force, slip, i, float(load), order)
            for i, load in enumerate(loads)
        ),
        definition=str(fitted.definition),
        doubted=_in_order((bool(fitted.slip.doubts), False), order),
        band=BAND,
        place=Place(
            place.inside, place.outside, float(slip[place.slip]), float(loads[place.load]),
            place.ratio, place.difference,
        ),
    )  # fmt: skip


def _fitted(path: Path, rng: np.random.Generator) -> _Fitted:
    slip = parse_slip(str(path), with_walks=False)
    if not isinstance(slip.law, SlipCurve):
        raise DataError("is an assumed friction, not a calibration", file=path)
    values = law_draws(slip, slip.law, DRAWS, rng=rng)
    return _Fitted(slip, slip.law, values,
                   read_fitted_blocks(slip.files[0], str(slip.law.definition)))  # fmt: skip


def _loads(fitted: _Fitted, given: GivenCurve, calibration: Path) -> Array:
    """Return the loads to compare at [N]: the curve's inside the tested range, else the tested."""
    low, high = fitted.curve.load_range
    if given.loads is not None:
        inside = [x for x in given.loads if (1 - _SAME) * low <= x <= (1 + _SAME) * high]
        if not inside:
            said = ", ".join(f"{x:.4g}" for x in given.loads)
            raise DataError(
                f"was tested at {low:.3g} to {high:.3g} N, {given.text} is for {said} N: no load "
                "is common to both",
                file=calibration,
            )
        return np.array(inside)
    levels = read_slip_file(fitted.slip.files[0]).levels
    return np.array(levels) if levels else np.unique(np.linspace(low, high, 3))


def _slips(curve: SlipCurve) -> Array:
    """Return tested slip ratios, closer to each other near zero and without zero, (n,) [-].

    A side that reaches less than a twentieth as far as the other is noise about zero slip.
    """
    spaced = np.linspace(_FIRST, 1.0, _SLIPS) ** 2  # peaks are narrow and near zero
    ends = (min(curve.slip_range[0], 0.0), max(curve.slip_range[1], 0.0))
    reach = max(map(abs, ends))
    return np.unique(np.concatenate([end * spaced for end in ends if abs(end) > _SIDE * reach]))


def _quantities(
    fitted: _Fitted, given: GivenCurve, loads: Array, forces: Array, force: Array, slip: Array,
    band: CurveBand,
) -> list[tuple[str, str, tuple[Array, Array]]]:  # fmt: skip
    """Return name, unit, and draws of calibration and curve of what both have, load by load."""
    found: list[tuple[str, str, tuple[Array, Array]]] = []
    columns, law, n = fitted.values.T, fitted.curve.law, len(fitted.values)
    for i, load in enumerate(loads):
        at = f"at {load:.3g} N"
        own_slip = np.minimum(np.broadcast_to(law.peak_slip(load, columns), n), fitted.limit)
        own = np.broadcast_to(law.force(own_slip, load, columns), n)
        peak = _peak(given, float(load), fitted)
        slope = given.own_slope(float(load))
        if peak is not None and peak[0] > 0:
            found.append((f"peak slip {at}", "", (own_slip, np.array([peak[0]]))))
        if peak is not None:
            found.append((f"peak force {at}", "N", (own, np.array([peak[1]]))))
        if np.isfinite(slope):
            initial = np.broadcast_to(law.slip_derivative(0.0, load, columns), n)
            found.append((f"slope at zero slip {at}", "N", (initial, np.array([slope]))))
        apart = np.abs(force[i] - band.mean[i])
        if np.isfinite(apart).any():
            j = int(np.nanargmax(apart))
            name = f"most apart, slip {slip[j]:.3g} {at}"
            found.append((name, "N", (forces[:, i, j], np.array([force[i, j]]))))
    return found


def _peak(given: GivenCurve, load: float, fitted: _Fitted) -> tuple[float, float] | None:
    """Return slip and force [N] of a curve's largest force up to the largest tested slip.

    Slip 0 for a curve that is as large from the first slip on; None where the curve is unknown.
    """
    spaced = fitted.limit * np.linspace(0.0, 1.0, _PEAK_SLIPS + 1)[1:] ** 2
    force = given.force(spaced, load, fitted.definition)
    if not np.isfinite(force).any():
        return None
    top = int(np.nanargmax(force))
    return (float(spaced[top]) if top else 0.0), float(force[top])


def _drawn(
    fitted: _Fitted, band: CurveBand, force: Array, slip: Array, index: int, load: float,
    order: tuple[int, int],
) -> Curve:  # fmt: skip
    own = np.stack([band.low[index], band.mean[index], band.high[index]])
    bands = (own, np.stack([force[index]] * 3))
    points = np.empty((2, 0))
    if fitted.blocks is not None:
        blocks = fitted.blocks
        near = np.abs(blocks.normal_force - load) <= _NEAR * load
        points = np.stack([blocks.slip[near], blocks.traction_force[near]])
    return Curve(slip, load, np.stack(_in_order(bands, order)), points)


def _words(
    names: tuple[str, str], order: tuple[int, int], place: Farthest, loads: Array, slip: Array,
    force: Array,
) -> tuple[str, ...]:  # fmt: skip
    """Say whether the curve lies inside the band of whole curves, and where it does not."""
    calibration, curve = (names[i] for i in order)
    known = np.isfinite(force)
    where = f"slip {slip[place.slip]:.3g} and {loads[place.load]:.3g} N"
    part = "" if known.all() else f" (compared at the {known.mean():.0%} that the curve covers)"
    if place.inside:
        words = (
            f"{curve} lies inside the band that holds 90 % of whole curves of {calibration}, at "
            f"all tested slips and loads; it comes nearest to its edge at {where}, "
            f"{place.ratio:.0%} of the way"
        )
    else:
        words = (
            f"{curve} lies outside the band that holds 90 % of whole curves of {calibration} at "
            f"{place.outside:.0%} of the tested slips and loads; it is farthest at {where}: "
            f"{abs(place.difference):.3g} N {'above' if place.difference > 0 else 'below'}, "
            f"{place.ratio:.3g} half widths of the band"
        )
    return (words + part,)


def _ordered(name: str, unit: str, pair: tuple[Array, Array], order: tuple[int, int]) -> Quantity:
    return Quantity(name, unit, _in_order(pair, order))


def _in_order(pair: tuple[_T, _T], order: tuple[int, int]) -> tuple[_T, _T]:
    """Return calibration and curve as first and second."""
    return pair[order[0]], pair[order[1]]
