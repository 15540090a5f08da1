# SPDX-License-Identifier: MIT
"""Values of a comparison: quantities with draws, and curves and paths to draw."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.metrics.difference import Difference, difference
from model.poses import Poses
from model.slip.law import Array


@dataclass(frozen=True)
class Quantity:
    """A quantity that both have.

    Attributes:
        name: Name of the quantity.
        unit: Its unit as shown; empty for none.
        draws: Draws of the first's and of the second's, each of shape (n,).
    """

    name: str
    unit: str
    draws: tuple[Array, Array]

    def quantiles(self, which: int) -> tuple[float, float, float]:
        """Return median, 5 % and 95 % quantile of the first (0) or of the second (1)."""
        low, median, high = np.quantile(self.draws[which], [0.05, 0.5, 0.95])
        return float(median), float(low), float(high)

    def difference(self, rng: np.random.Generator) -> Difference:
        """Return the difference, the second minus the first."""
        return difference(*self.draws, rng=rng)


@dataclass(frozen=True)
class Curve:
    """Bands of both slip curves at one load, for the picture.

    Attributes:
        slip: Slip ratios, shape (n,) [-].
        load: Normal force [N].
        bands: 5, 50 and 95 % quantile of traction, of the first and of the second, (2, 3, n) [N].
    """

    slip: Array
    load: float
    bands: Array


@dataclass(frozen=True)
class RunPaths:
    """Track and prediction of one run for the picture, started at the origin along x.

    Attributes:
        track: Its track; None if it has none.
        band: Its predicted paths; None if it has none.
    """

    track: Poses | None
    band: Poses | None


@dataclass(frozen=True)
class Comparison:
    """Two calibrations or two runs, compared.

    Attributes:
        kind: "calibrations" or "runs".
        names: Names to show for them.
        quantities: Quantities that both have.
        curves: Their slip curves, one per load; empty for runs.
        paths: Their paths; empty for calibrations.
        definition: Slip definition; empty for runs.
        source: Where the data come from.
        files: Files that were read.
        notes: Notes, one line each.
    """

    kind: str
    names: tuple[str, str]
    quantities: tuple[Quantity, ...]
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    curves: tuple[Curve, ...] = ()
    paths: tuple[RunPaths, ...] = ()
    definition: str = ""
