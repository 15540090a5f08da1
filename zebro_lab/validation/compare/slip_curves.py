# SPDX-License-Identifier: MIT
"""Compare the slip curves of two calibrations, or of a calibration and a given curve."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.slip.curve import SlipCurve
from model.slip.curve_band import farthest, simultaneous_band
from model.slip.definition import SlipDefinition
from zebro_lab.calibration.curve_argument import GivenCurve, is_curve, parse_curve
from zebro_lab.calibration.folder import read_slip_file
from zebro_lab.calibration.posterior_file import law_draws, read_block_means
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.validation.compare.values import Comparison, Curve, Place, Quantity

DRAWS: Final = 1000
_SLIPS = 500  # points of each half of a curve: 1.4 % apart at a peak slip of 0.05
_FIRST = 0.03  # root of the first slip over the largest: at zero slip curves have no difference
_SIDE = 0.05  # of the farther side: reach from which a side was tested, not noise about zero slip
_NEAR = 0.1  # relative difference of loads up to which a block is drawn at a load
_SAME = 0.02  # relative difference of a load from the tested range that is taken for inside


class _Fitted:
    """The slip curve of a calibration, with `DRAWS` posterior draws of its parameters.

    Raises:
        DataError: The path holds an assumed friction law instead of a calibrated curve.
    """

    def __init__(self, path: Path, rng: np.random.Generator) -> None:
        self.slip = parse_slip(str(path), with_walks=False)
        if not isinstance(self.slip.law, SlipCurve):
            raise DataError("is an assumed friction, not a calibration", file=path)
        self.path, self.curve = path, self.slip.law
        self.columns = law_draws(self.slip, self.curve, DRAWS, rng=rng).T
        self.source, self.files = self.slip.source, self.slip.files
        self.notes = self.slip.notes

    def force(self, slip: Array, load: float) -> Array:
        """Compute the force of each draw, shape (draws, slips) [N]."""
        force = self.curve.law.force(slip, load, self.columns[:, :, None])
        return np.broadcast_to(force, (self.columns.shape[1], len(slip)))

    def slope(self, load: float) -> Array:
        """Compute the slope at zero slip of each draw, shape (draws,) [N]."""
        slope = self.curve.law.slip_derivative(0.0, load, self.columns)
        return np.broadcast_to(slope, self.columns.shape[1])

    def points(self, load: float) -> Array:
        """Read slip ratios and forces of block means within `_NEAR` of a load, shape (2, k)."""
        slip, loads, force = read_block_means(self.files[0])
        near = np.abs(loads - load) <= _NEAR * load
        return np.stack([slip[near], force[near]])


class _Given:
    """A curve without uncertainty, as one draw."""

    def __init__(self, given: GivenCurve, definition: SlipDefinition) -> None:
        self.given, self.definition = given, definition
        self.source, self.files = given.source, given.files
        self.notes = (*given.notes, *given.said(definition))

    def force(self, slip: Array, load: float) -> Array:
        """Compute the force, shape (1, slips) [N]; NaN where it is unknown."""
        return self.given.force(slip, load, self.definition)[None]

    def slope(self, load: float) -> Array:
        """Return the slope at zero slip, shape (1,) [N]: NaN if unknown, infinite for a jump."""
        return np.array([self.given.own_slope(load)])


_Side = _Fitted | _Given


def compare_slip(
    first: Path, second: Path, *, names: tuple[str, str], rng: np.random.Generator
) -> Comparison:
    """Compare peak slip, peak force and slope at zero slip of two slip curves at common loads.

    One may be a curve without uncertainty. It is judged by a band that holds 90 % of whole drawn
    curves of the calibration.

    Args:
        first: A calibration folder, or a curve.
        second: Another calibration folder, or a curve beside a calibration.
        names: Names to show for the first and the second.
        rng: Random number generator.

    Raises:
        ZebroLabError: A calibration or the curve cannot be read, neither is a calibration, or they
            have no slip definition, load or slip in common.
    """
    fitted = [_Fitted(path, rng) for path in (first, second) if not is_curve(path)]
    if not fitted:
        raise SettingsError(
            f"neither {first} nor {second} is a calibration; name the folder of one as A or B"
        )
    definition = fitted[0].curve.definition
    for each in fitted[1:]:
        if each.curve.definition is not definition:
            raise DataError(
                f"was fitted to '{each.curve.definition}' slip, the first to '{definition}' slip: "
                f"no axis is common to both; calibrate again with --slip-definition {definition}",
                file=each.path,
            )
    sides: list[_Side] = [*fitted]
    given = None
    if len(fitted) == 1:
        curve_first = is_curve(first)
        given = parse_curve(first if curve_first else second)
        sides.insert(0 if curve_first else 1, _Given(given, definition))
    loads, slip = _loads(fitted, given), _slips(fitted)
    forces = [np.stack([side.force(slip, load) for load in loads], axis=1) for side in sides]
    place, notes = None, []
    if given is not None:
        which = 0 if isinstance(sides[0], _Fitted) else 1
        place = _place(forces[which], forces[1 - which][0], loads, slip, given.text)
        notes.append(_verdict(place, calibration=names[which], curve=names[1 - which]))
    bands = [_band(each) for each in forces]
    return Comparison(
        kind="calibrations" if given is None else "calibration and curve",
        names=names,
        quantities=tuple(
            quantity for i, load in enumerate(loads) for quantity in _quantities(
                load, slip, [each[:, i] for each in forces], [side.slope(load) for side in sides]
            )
        ),
        source=", ".join(dict.fromkeys(side.source for side in sides if side.source)),
        files=tuple(dict.fromkeys(file for side in sides for file in side.files)),
        notes=(*(note for side in sides for note in side.notes), *notes),
        curves=tuple(
            Curve(slip, load, np.stack([band[:, i] for band in bands]),
                  np.empty((2, 0)) if given is None else fitted[0].points(load))
            for i, load in enumerate(loads)
        ),
        definition=str(definition),
        place=place,
    )  # fmt: skip


def _loads(fitted: list[_Fitted], given: GivenCurve | None) -> list[float]:
    """Return the loads at which the curves are compared [N], within the tested loads of all.

    They are the loads of the given curve, else those of the first calibration's test, in the range
    that all tested, with a margin of `_SAME`. If none of the latter is in this range, they are its
    lowest, middle and highest load.

    Raises:
        DataError: The ranges do not overlap, or no load of the given curve lies in them.
    """
    low = max(each.curve.load_range[0] for each in fitted)
    high = min(each.curve.load_range[1] for each in fitted)
    levels = read_slip_file(fitted[0].files[0]).levels
    if given is not None and given.loads is not None:
        levels = given.loads
    inside = [load for load in levels if (1 - _SAME) * low <= load <= (1 + _SAME) * high]
    if inside:
        return inside
    if low > high or (given is not None and given.loads is not None):
        tested = [f"{a:.3g} to {b:.3g} N" for a, b in (each.curve.load_range for each in fitted)]
        other = ", ".join(f"{load:.4g} N" for load in levels) if given is not None else tested[0]
        raise DataError(
            f"was tested at {tested[-1]}, the other is for {other}: no load is common to both; "
            "test one again at loads of the other",
            file=fitted[-1].path,
        )
    return sorted({low, (low + high) / 2, high})


def _slips(fitted: list[_Fitted]) -> Array:
    """Return slip ratios in the tested range of all, closest to each other near zero, shape (n,).

    Zero is left out, as is a side, positive or negative, that reaches up to `_SIDE` of the other.
    """
    ranges = [each.curve.slip_range for each in fitted]
    ends = (min(0.0, max(low for low, _ in ranges)), max(0.0, min(high for _, high in ranges)))
    spaced = np.linspace(_FIRST, 1.0, _SLIPS) ** 2  # peaks are narrow and near zero
    reach = max(map(abs, ends))
    return np.unique(np.concatenate([end * spaced for end in ends if abs(end) > _SIDE * reach]))


def _band(forces: Array) -> Array:
    """Compute lower edge, mean and upper edge of the simultaneous band of draws.

    Args:
        forces: Forces, shape (draws, loads, slips) [N]; if there is one draw, all three equal it.

    Returns:
        Forces, shape (3, loads, slips) [N].
    """
    if len(forces) == 1:
        return np.repeat(forces, 3, axis=0)
    band = simultaneous_band(forces)
    return np.stack([band.low, band.mean, band.high])


def _quantities(
    load: float, slip: Array, forces: Sequence[Array], slopes: Sequence[Array]
) -> Iterator[Quantity]:
    """Yield peak slip, peak force and slope at zero slip of both curves at a load, if known.

    Peaks are those of the side of zero slip that was tested farther, among the known forces.
    A feature is left out if a draw of it is not finite, the peak slip also if all draws of a curve
    peak at the smallest slip, as does a curve that jumps at zero slip.

    Args:
        load: Load [N].
        slip: Slip ratios, shape (n,) [-].
        forces: Forces of the draws of each curve, shape (draws, n) [N].
        slopes: Slope at zero slip of the draws of each curve, shape (draws,) [N].
    """
    side = slip > 0 if slip[-1] >= -slip[0] else slip < 0
    nearest = np.abs(slip[side]).min()
    sizes = [np.where(np.isfinite(each[:, side]), np.abs(each[:, side]), -1.0) for each in forces]
    unknown = [np.where(size.max(axis=1) < 0, np.nan, 0.0) for size in sizes]
    peaks = [np.abs(slip[side])[size.argmax(axis=1)] for size in sizes]
    pairs = (
        [at + gap for at, gap in zip(peaks, unknown, strict=True)],
        [size.max(axis=1) + gap for size, gap in zip(sizes, unknown, strict=True)],
        slopes,
    )
    names = (("peak slip", ""), ("peak force", "N"), ("slope at zero slip", "N"))
    for (name, unit), (one, other) in zip(names, pairs, strict=True):
        known = np.isfinite(one).all() and np.isfinite(other).all()
        if known and not (name == "peak slip" and min(one.max(), other.max()) == nearest):
            yield Quantity(f"{name} at {load:.3g} N", unit, (one, other))


def _place(forces: Array, curve: Array, loads: list[float], slip: Array, text: str) -> Place:
    """Find where a given curve lies in the simultaneous band of a calibration's draws.

    Args:
        forces: Forces of the draws, shape (draws, loads, slips) [N].
        curve: Forces of the given curve, shape (loads, slips) [N]; NaN where it is unknown.
        loads: Loads [N].
        slip: Slip ratios, shape (slips,) [-].
        text: Name of the given curve, for the error.

    Raises:
        DataError: The given curve is unknown at all slip ratios and loads.
    """
    if not np.isfinite(curve).any():
        raise DataError(
            f"{text} has no point at a tested slip ratio, {slip.min():.3g} to {slip.max():.3g}"
        )
    far = farthest(simultaneous_band(forces), curve)
    at_slip, at_load = float(slip[far.slip]), loads[far.load]
    return Place(far.inside, far.outside, at_slip, at_load, far.ratio, far.difference)


def _verdict(place: Place, *, calibration: str, curve: str) -> str:
    """Say whether the curve lies inside the band of whole curves, and where it is farthest."""
    outside = f"outside at {place.share_outside:.0%} of the tested slips and loads"
    where = "inside at all tested slips and loads" if place.inside else outside
    return (
        f"{curve} lies {where} of the band that holds 90 % of whole curves of {calibration}; it is "
        f"farthest at slip {place.slip:.3g} and {place.load_n:.3g} N: {abs(place.difference_n):.3g}"
        f" N {'above' if place.difference_n > 0 else 'below'} the mean, {place.half_widths:.3g} "
        "half widths of the band"
    )
