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

    def difference(self, rng: np.random.Generator) -> Difference:
        """Compute median, 90 % interval and sign probability of the second minus the first.

        Raises:
            InsufficientData: A draw is not finite.
        """
        return difference(*self.draws, rng=rng)


@dataclass(frozen=True)
class Curve:
    """Bands of both slip curves at one load, for the picture.

    Attributes:
        slip: Slip ratios, shape (n,) [-].
        load: Normal force of both curves [N].
        bands: Traction [N], shape (2, 3, n): first and second; 5, 50 and 95 % quantile.
    """

    slip: Array
    load: float
    bands: Array


@dataclass(frozen=True)
class RunPaths:
    """Track and prediction of one run for the picture.

    Attributes:
        track: Tracked poses, moved to start at the origin along x; None without a track.
        band: Predicted paths in the inertial frame, where a walk starts so; None without draws.
    """

    track: Poses | None
    band: Poses | None


@dataclass(frozen=True)
class Comparison:
    """Comparison of two calibrations or two runs.

    Attributes:
        kind: "calibrations" or "runs".
        names: Names to show for the first and the second.
        quantities: Quantities that both have, with draws.
        curves: Bands of both slip curves, one item per load; empty for runs.
        paths: Paths of the first and of the second run; empty for calibrations.
        definition: Slip definition of the curves; empty for runs.
        doubted: Whether each is a calibration that is not trustworthy.
        source: Sources of both, joined by commas.
        files: Files that were read, without `posterior.nc` and manifests.
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
    doubted: tuple[bool, bool] = (False, False)
