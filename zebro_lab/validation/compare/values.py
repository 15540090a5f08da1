# SPDX-License-Identifier: MIT
"""Values of a comparison: quantities with draws, and curves and paths to draw."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.poses import Poses


@dataclass(frozen=True)
class Quantity:
    """A quantity of two calibrations or runs, with its uncertainty as draws.

    Attributes:
        name: Name of the quantity.
        unit: Unit of the draws, as shown; empty for a pure number.
        draws: Draws for the first, shape (n,), and for the second, shape (m,).
    """

    name: str
    unit: str
    draws: tuple[Array, Array]

    def quantiles(self, which: int) -> tuple[float, float, float]:
        """Return median, 5 % and 95 % quantile of the draws for the first (0) or second (1)."""
        low, median, high = np.quantile(self.draws[which], [0.05, 0.5, 0.95])
        return float(median), float(low), float(high)


@dataclass(frozen=True)
class Curve:
    """Bands of both slip curves at one load, for the picture.

    Attributes:
        slip: Slip ratios, shape (n,) [-].
        load: Normal force of both curves [N].
        bands: Traction [N], shape (2, 3, n): first and second; lower edge, mean and upper edge of
            the band, all the same for a curve without uncertainty.
        points: Slip ratios [-] and traction forces [N] of block means within 10 % of this load,
            shape (2, k); k is 0 for two calibrations.
    """

    slip: Array
    load: float
    bands: Array
    points: Array


@dataclass(frozen=True)
class Place:
    """Where a curve lies in the band of a calibration's curves.

    Attributes:
        inside: Whether it lies inside at all tested slips and loads.
        share_outside: Share of the tested slips and loads at which it lies outside [-].
        slip: Slip ratio at which the curve is farthest from the mean, counted in half widths [-].
        load_n: Load there [N].
        half_widths: Its distance from the mean there, in half widths of the band [-].
        difference_n: Curve minus mean there [N].
    """

    inside: bool
    share_outside: float
    slip: float
    load_n: float
    half_widths: float
    difference_n: float


@dataclass(frozen=True)
class Comparison:
    """Comparison of two calibrations, of a calibration and a curve, or of two runs.

    Attributes:
        kind: "calibrations", "calibration and curve" or "runs".
        names: Names to show for the first and the second.
        quantities: Quantities that both have, with draws.
        source: Sources of both, joined by commas.
        files: Files that were read, without `posterior.nc` and manifests.
        notes: Notes, one line each.
        curves: Bands of both slip curves, one item per load; empty for runs.
        paths: Tracked poses of both runs, moved to start at the origin along x; empty for
            calibrations.
        definition: Slip definition of the curves; empty for runs.
        place: Where a curve lies in the band of a calibration; None without a curve.
    """

    kind: str
    names: tuple[str, str]
    quantities: tuple[Quantity, ...]
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    curves: tuple[Curve, ...] = ()
    paths: tuple[Poses, ...] = ()
    definition: str = ""
    place: Place | None = None
