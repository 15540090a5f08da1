# SPDX-License-Identifier: MIT
"""Two of a kind side by side: what is compared, by how much they differ, how sure that is."""

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
        name: What it is.
        unit: Its unit as it is shown; empty for none.
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
        """Return the second minus the first."""
        return difference(*self.draws, rng=rng)


@dataclass(frozen=True)
class Curve:
    """A slip curve's band at one load, as a picture shows it.

    Attributes:
        slip: Slip ratios, shape (n,) [-].
        load: Normal force [N].
        bands: 5, 50 and 95 % quantile of traction, of the first and of the second, (2, 3, n) [N].
    """

    slip: Array
    load: float
    bands: Array


@dataclass(frozen=True)
class Walked:
    """One run as a picture shows it, started at the origin along x.

    Attributes:
        track: Its track; None where it has none.
        band: Its predicted paths; None where it has none.
    """

    track: Poses | None
    band: Poses | None


@dataclass(frozen=True)
class Comparison:
    """Two calibrations or two runs, compared.

    Attributes:
        kind: "calibrations" or "runs".
        names: What they are called.
        quantities: What both have.
        curves: Their slip curves, load by load; empty for runs.
        walked: Their paths; empty for calibrations.
        definition: Of slip ratios; empty for runs.
        source: Where they come from.
        files: Files that were read.
        notes: For a person, one line each.
    """

    kind: str
    names: tuple[str, str]
    quantities: tuple[Quantity, ...]
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    curves: tuple[Curve, ...] = ()
    walked: tuple[Walked, ...] = ()
    definition: str = ""
