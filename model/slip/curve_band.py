# SPDX-License-Identifier: MIT
"""Simultaneous band of slip curves: it holds whole curves with a stated probability."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.errors import InsufficientData

_FEWEST_DRAWS = 20


@dataclass(frozen=True)
class CurveBand:
    """Band around the mean curve, of half width `factor` standard deviations everywhere.

    Attributes:
        mean: Mean force at each load and slip ratio, shape (m, n) [N].
        sd: Standard deviation there, shape (m, n) [N].
        factor: Quantile, over the draws, of the largest distance of a curve from the mean in
            standard deviations [-].
    """

    mean: Array
    sd: Array
    factor: float

    @property
    def low(self) -> Array:
        """Lower edge, shape (m, n) [N]."""
        return self.mean - self.factor * self.sd

    @property
    def high(self) -> Array:
        """Upper edge, shape (m, n) [N]."""
        return self.mean + self.factor * self.sd


def simultaneous_band(forces: Array, *, level: float = 0.9) -> CurveBand:
    r"""Compute the band that holds a share of whole curves, at every load and slip at once.

    .. math::
        \max_{i,j} \frac{|f_{ij} - \bar f_{ij}|}{s_{ij}} \le c

    for a share `level` of the draws, with their mean and standard deviation s at each load i and
    slip ratio j (a sup-t band). A pointwise band of quantiles holds a smaller share of whole
    curves, and so leaves out a true curve somewhere more often than it says. Points at which all
    draws agree, s = 0, do not count.

    Args:
        forces: Forces of w drawn curves, shape (w, m, n) [N].
        level: Share of curves that lie inside everywhere [-].

    Raises:
        InsufficientData: There are fewer than 20 draws.
    """
    if len(forces) < _FEWEST_DRAWS:
        raise InsufficientData(
            f"{len(forces)} drawn curves; a band needs {_FEWEST_DRAWS} or more: compare a "
            "calibration that has an uncertainty"
        )
    mean, sd = forces.mean(axis=0), forces.std(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = np.where(sd > 0, np.abs(forces - mean) / sd, 0.0)
    return CurveBand(mean, sd, float(np.quantile(distance.max(axis=(1, 2)), level)))


@dataclass(frozen=True)
class Farthest:
    """Where a curve is farthest from a band, and how much of it lies outside.

    Attributes:
        outside: Share of the points where the curve is known at which it is outside the band [-].
        load: Index of the load at which it is farthest.
        slip: Index of the slip ratio there.
        ratio: Distance from the mean over half the width of the band there; above 1 outside.
        difference: Curve minus mean there [N].
    """

    outside: float
    load: int
    slip: int
    ratio: float
    difference: float

    @property
    def inside(self) -> bool:
        """Whether the curve lies inside the band at every point at which it is known."""
        return self.outside == 0


def farthest(band: CurveBand, force: Array) -> Farthest:
    """Find where a curve is farthest from a band, in half widths of the band.

    Args:
        band: The band, at m loads and n slip ratios.
        force: Forces of the curve, shape (m, n) [N]; NaN where it is unknown, which does not count.

    Raises:
        InsufficientData: The curve is known at no point.
    """
    known = np.isfinite(force)
    if not known.any():
        raise InsufficientData("the curve is known at no slip ratio and load that was tested")
    # A least half width keeps the ratio finite where all draws agree.
    half = np.maximum(band.factor * band.sd, 1e-12 * np.abs(band.mean).max())
    ratio = np.where(known, np.abs(force - band.mean) / half, -np.inf)
    load, slip = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
    outside = float(np.mean(ratio[known] > 1))
    return Farthest(outside, int(load), int(slip), float(ratio[load, slip]),
                    float(force[load, slip] - band.mean[load, slip]))  # fmt: skip
