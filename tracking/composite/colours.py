# SPDX-License-Identifier: MIT
"""Models of colour: of the floor, and of any part of a picture."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from scipy.stats import chi2

from model.arrays import Array

_TRUSTED = 0.7  # share of the points from which the floor's covariance is estimated
_OUTLIER = 12.0  # squared distance beyond which a colour is an outlier for the floor's light
_ROUNDS = 5  # of the robust estimate of the floor's covariance
_SHADOW = 0.4  # least share of the floor's light that is left in shadow
_NO_FLOOR = 20.0  # squared distance beyond which a colour is not the floor's
_LEVELS = 32  # bins of each channel in the histogram of colours
_RARE = 0.1  # share of the density of colours that is uniform over all


NOISE = 12.0
"""Standard deviation of the robot's colour, per channel, between exposures [grey levels]."""


@dataclass(frozen=True)
class FloorColours:
    """Colour model of a floor: light, which varies slowly, and covariance of the pattern about it.

    Attributes:
        light: Colour of the floor without its pattern, shape (rows, columns, 3) [grey levels].
        covariance: Covariance of the floor's colours about `light`, shape (3, 3) [grey levels²].
    """

    light: NDArray[np.float32]
    covariance: Array

    @classmethod
    def of(
        cls, picture: NDArray[np.float32], used: NDArray[np.bool_], *, width: float, noise: float
    ) -> "FloorColours":
        """Estimate the model robustly from a picture of which the greater part is floor.

        Args:
            picture: Colours, shape (rows, columns, 3).
            used: True at points that show the floor or the robot, shape (rows, columns).
            width: Standard deviation of the blur that gives `light` [points].
            noise: Standard deviation of noise added to the covariance, per channel [grey levels].

        Returns:
            The model; up to three tenths of the points used may show the robot.
        """
        light = _smooth(picture, used, width)
        # Variance of the nearest `_TRUSTED` of a Gaussian's points in 3-D, over that of all
        inner = chi2.cdf(chi2.ppf(_TRUSTED, 3), 5) / _TRUSTED
        covariance = np.cov((picture - light)[used].T)
        for _ in range(_ROUNDS):
            floor = cls(light, covariance + noise**2 * np.eye(3))
            far = floor.floor_distance(picture)
            usual = used & (far < np.quantile(far[used], _TRUSTED))
            covariance = np.cov((picture - light)[usual].T) / inner
            light = _smooth(picture, used & (far < max(_OUTLIER, np.median(far[used]))), width)
        return cls(light, covariance + noise**2 * np.eye(3))

    @cached_property
    def whitening(self) -> Array:
        """Whitening matrix W of the pattern, for colours as rows: (n, 3) @ W, shape (3, 3)."""
        return np.linalg.cholesky(np.linalg.inv(self.covariance))

    def floor_distance(self, picture: NDArray[np.float32]) -> NDArray[np.float32]:
        """Compute the squared Mahalanobis distance of colours from `light`, (rows, columns)."""
        return (((picture - self.light) @ self.whitening) ** 2).sum(axis=-1).astype(np.float32)

    def shows(self, picture: NDArray[np.float32]) -> NDArray[np.bool_]:
        """Compute the mask of points whose colour is the floor's, lit or in shadow.

        Its squared Mahalanobis distance from the nearest of the colours from 0.4 to 1 times `light`
        is below 20. Shape (rows, columns).
        """
        seen, light = picture @ self.whitening, self.light @ self.whitening
        share = (seen * light).sum(axis=-1) / np.maximum((light**2).sum(axis=-1), 1e-6)
        lit = np.clip(share, _SHADOW, 1.0)[..., None] * light
        return ((seen - lit) ** 2).sum(axis=-1) < _NO_FLOOR


def colour_density(
    samples: NDArray[np.float32], colours: NDArray[np.float32], *, blur: float
) -> Array:
    """Estimate the density of colours, per cubed grey level, by a blurred histogram of samples.

    A tenth of the density is uniform, so that it is never 0; without samples there is only that.

    Args:
        samples: BGR, shape (n, 3) [grey levels].
        colours: BGR of the points where the density is wanted, shape (..., 3) [grey levels].
        blur: Standard deviation of the Gaussian blur [bins, of 32 a channel].

    Returns:
        Density, shape (...).
    """
    counts, _ = np.histogramdd(samples, bins=(_LEVELS,) * 3, range=[(0, 256)] * 3)
    known = gaussian_filter(counts, blur) / max(len(samples), 1) / (256 / _LEVELS) ** 3
    table = (1 - _RARE) * known + _RARE / 256**3
    cell = np.clip(colours * (_LEVELS / 256), 0, _LEVELS - 1).astype(int)
    return table[cell[..., 0], cell[..., 1], cell[..., 2]]


def robot_density(difference: Array) -> Array:
    """Compute the normal density, standard deviation `NOISE`, of colour differences (..., 3).

    Returns:
        Density per cubed grey level, shape (...).
    """
    norm = (2 * np.pi) ** 1.5 * NOISE**3
    square = np.einsum("...i,...i", difference, difference)
    return np.exp(-0.5 * square / NOISE**2) / norm


def _smooth(
    picture: NDArray[np.float32], used: NDArray[np.bool_], width: float
) -> NDArray[np.float32]:
    """Blur colours by a Gaussian over the points used (normalised convolution).

    Args:
        picture: Colours, shape (rows, columns, 3).
        used: True at points to average over, shape (rows, columns).
        width: Standard deviation of the blur [points].

    Returns:
        Blurred colours, shape (rows, columns, 3); towards 0 far from all points used.
    """
    weight = used.astype(np.float32)
    total = cv2.GaussianBlur(picture * weight[..., None], (0, 0), width)
    share = cv2.GaussianBlur(weight, (0, 0), width)
    return np.asarray(total / np.maximum(share, 1e-3)[..., None], dtype=np.float32)
