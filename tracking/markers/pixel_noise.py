# SPDX-License-Identifier: MIT
"""Covariance of a least-squares fit to pixels whose errors are correlated.

Compression and the model's own faults make the errors of neighbouring pixels alike, so that the
number of pixels overstates what they tell. The correlation is estimated from the fit's residual, as
an autocovariance by the lag between two pixels, and corrected for what the fit has taken out of it.
All sums over pairs of pixels are computed by Fourier transforms on a rectangle around the pixels.
"""

from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import fft

from model.arrays import Array

_Field: TypeAlias = NDArray[np.float32]
_Waves: TypeAlias = NDArray[np.complex64]

_LARGEST_SHARE = 0.7
"""Largest share of the unknowns' variance by which a residual is taken to be too small."""


def unknowns_covariance(
    points: Array, design: Array, inverse: Array, residual: Array, *, first: int, lags: int
) -> Array:
    """Compute the covariance of the first unknowns of a least-squares fit to pixels.

    Least squares of design J with an error of covariance R: W J'RJ W, W = (J'J)^-1. R is estimated
    from the residual: pixels at the same lag from each other have the same covariance, 0 beyond
    the largest lag.

    The fit takes a part of the error into its unknowns. What is left has the covariance M R M,
    M = 1 - J W J', and lacks what is most like a change of the unknowns. The missing part,
    R - M R M = R J W J' + J W J' R - J W J'RJ W J', follows from R and is added. Computed from
    what is left, the part 1 - q of R, it gives 1 - q² of R; q is by how much it raises the
    unknowns' variance, at most `_LARGEST_SHARE`.

    Args:
        points: Column and row of each pixel, whole numbers, shape (n, 2) [px].
        design: Derivative of the modelled pixels by the unknowns, shape (n, k).
        inverse: Inverse of the normal equations' matrix, W, shape (k, k).
        residual: Pixels minus the fitted model, shape (n,) [grey levels].
        first: How many of the unknowns are wanted.
        lags: Largest lag at which errors are correlated [px].

    Returns:
        Covariance of the first unknowns, shape (first, first), in their units squared.
    """
    rectangle = _Rectangle.around(points, lags=lags)
    remaining = rectangle.transform(residual[:, None])
    waves = rectangle.transform(design)  # J
    weighted = _mixed(inverse, waves)  # W J'
    # M R M by lag, as the residual shows it; from it, in place of R, the missing part by lag
    seen = rectangle.mean_products(remaining, remaining)
    spectrum = rectangle.spectrum(seen)
    inner = rectangle.inner(waves, spectrum)
    smeared = rectangle.masked(spectrum * waves)
    missing = rectangle.mean_products(2 * smeared - _mixed(inner, weighted), weighted)
    by_remaining = _sandwich(inverse[:first], inner)
    inner = rectangle.inner(waves, rectangle.spectrum(seen + missing))
    covariance = _sandwich(inverse[:first], inner)
    raised = np.trace(covariance) / max(np.trace(by_remaining), 1e-30) - 1
    share = np.clip(raised, 0.0, _LARGEST_SHARE)
    return covariance / (1 - share**2)


@dataclass(frozen=True)
class _Rectangle:
    """A rectangle around pixels, with room for lags between them, so that none wraps around.

    Fields on it are of single precision: a covariance needs no more, and it takes half the time.

    Attributes:
        row: Row of each pixel, from the topmost one, shape (n,).
        column: Column of each pixel, from the leftmost one, shape (n,).
        used: 1 where a pixel is, 0 elsewhere, shape (height, width).
        pairs: Number of pairs of pixels by their lag, at least 1, shape (height, width); negative
            lags from the end.
        lags: Largest lag of rows and of columns [px].
    """

    row: NDArray[np.intp]
    column: NDArray[np.intp]
    used: _Field
    pairs: _Field
    lags: int

    @classmethod
    def around(cls, points: Array, *, lags: int) -> "_Rectangle":
        """Draw it around pixels at columns and rows `points`, shape (n, 2)."""
        column, row = (points - points.min(axis=0)).astype(int).T
        # A patch may be smaller than the largest lag.
        height, width = (
            cv2.getOptimalDFTSize(max(int(each.max()) + 1 + lags, 2 * lags + 1))
            for each in (row, column)
        )
        used = np.zeros((height, width), np.float32)
        used[row, column] = 1.0
        power = np.abs(np.asarray(fft.rfft2(used))) ** 2
        pairs = np.maximum(np.asarray(fft.irfft2(power, used.shape), np.float32), 1.0)
        return cls(row, column, used, pairs, lags)

    def transform(self, fields: Array) -> _Waves:
        """Compute the Fourier transforms of k fields, given at the pixels, shape (n, k)."""
        laid = np.zeros((fields.shape[1], *self.used.shape), np.float32)
        laid[:, self.row, self.column] = fields.T
        return np.asarray(fft.rfft2(laid), np.complex64)

    def masked(self, waves: _Waves) -> _Waves:
        """Set transformed fields to 0 where no pixel is."""
        fields = np.asarray(fft.irfft2(waves, self.used.shape), np.float32)
        return np.asarray(fft.rfft2(fields * self.used), np.complex64)

    def mean_products(self, left: _Waves, right: _Waves) -> _Field:
        """Average left(p) right(p + lag), summed over the k transformed fields, by lag.

        Averages at a lag and at the opposite one are averaged, too. Shape (height, width), negative
        lags from the end.
        """
        power = np.einsum("kij,kij->ij", left, right.conj()).real
        return np.asarray(fft.irfft2(power, self.used.shape), np.float32) / self.pairs

    def spectrum(self, kernel: _Field) -> _Field:
        """Transform a covariance by lag, tapered; a product with it smears by the covariance.

        The taper is 1 to half the largest lag, then falls to 0 beyond it. Estimates of far lags
        are mostly noise; Bartlett's taper, which falls at once, takes a third off the correlation
        of near ones.
        """
        down, across = (
            np.clip(2 * (1 - np.minimum(lag, len(lag) - lag) / (self.lags + 1)), 0.0, 1.0)
            for lag in map(np.arange, self.used.shape)
        )
        tapered = kernel * np.outer(down, across).astype(np.float32)
        return np.asarray(fft.rfft2(tapered), np.complex64).real

    def inner(self, waves: _Waves, spectrum: _Field) -> Array:
        """Compute J'RJ of transformed fields J (k) and a covariance R, shape (k, k); Parseval."""
        columns = self.used.shape[1]
        twice = np.full(waves.shape[2], 2.0, np.float32)  # of each pair of conjugates one is there
        twice[0] = 1.0
        if columns % 2 == 0:
            twice[-1] = 1.0
        flat = waves.reshape(len(waves), -1)
        weighed = flat * (spectrum * twice).ravel()
        inner = (weighed.real @ flat.real.T + weighed.imag @ flat.imag.T) / self.used.size
        return np.asarray(inner + inner.T, float) / 2


def _sandwich(rows: Array, inner: Array) -> Array:
    """Compute W J'RJ W of the given rows of W, without the negative variances of J'RJ."""
    # A taper that is flat in the middle may leave a slightly negative variance.
    values, vectors = np.linalg.eigh(inner)
    root = rows @ vectors * np.sqrt(np.maximum(values, 0.0))
    return root @ root.T


def _mixed(matrix: Array, waves: _Waves) -> _Waves:
    """Multiply a matrix (m, k) by k transformed fields; return m transformed fields."""
    return np.asarray(np.tensordot(matrix.astype(np.float32), waves, axes=1), np.complex64)
