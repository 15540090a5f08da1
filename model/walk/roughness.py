# SPDX-License-Identifier: MIT
r"""Rough ground: a Gaussian random field, drawn by the fast Fourier transform.

Heights have mean zero and the square-exponential covariance

.. math::
    C(d) = \sigma^2 \exp\left(-\frac{d^2}{2 \ell^2}\right)

with standard deviation sigma, correlation length l and distance d. The field is drawn on a square
that repeats itself, a hundred correlation lengths wide, so that a walk comes to no edge.
"""

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.walk.ground import Ground

CELLS = 1024  # along a side of the square
CELLS_A_LENGTH = 10  # cells in a correlation length: bilinear heights are within 0.2 % of sigma
STEEPEST = 0.5  # root mean square of the slope along x or y, up to which contacts are found


def rough_ground(sd: float, correlation: float, *, rng: np.random.Generator) -> Ground:
    """Draw rough ground; its slope along x, and along y, has the standard deviation sd/correlation.

    Args:
        sd: Standard deviation sigma of the heights [m].
        correlation: Correlation length l, a tenth of which is the step of the grid [m].
        rng: Source of randomness.

    Raises:
        DomainError: A length is not above zero and finite, or the ground is steeper than 0.5.
    """
    if not (sd > 0 and correlation > 0 and np.isfinite(sd) and np.isfinite(correlation)):
        raise DomainError(
            f"sd is {sd:g} and correlation {correlation:g} m; expected both above zero, finite"
        )
    if sd / correlation > STEEPEST:
        raise DomainError(
            f"an sd of {sd:g} m with a correlation length of {correlation:g} m is ground with "
            f"slopes of {sd / correlation:.3g} (root mean square); expected at most {STEEPEST:g}: "
            "a smaller sd or a longer correlation"
        )
    step = correlation / CELLS_A_LENGTH
    height = np.empty((CELLS + 1, CELLS + 1))
    height[:-1, :-1] = sd * _field(correlation / step, rng)
    height[-1, :-1] = height[0, :-1]
    height[:, -1] = height[:, 0]
    return Ground(0.0, 0.0, step, height, float(height.max()), repeats=True)


def _field(correlation: float, rng: np.random.Generator) -> Array:
    """Draw a field of unit variance, correlation length in cells, shape (CELLS, CELLS)."""
    k = 2 * np.pi * np.fft.fftfreq(CELLS)
    # square root of the spectrum along one axis; that of both is the product
    size = np.exp(-0.25 * (k * correlation) ** 2)
    size /= np.sqrt(np.mean(size**2))
    white = np.fft.rfft2(rng.standard_normal((CELLS, CELLS)))
    return np.fft.irfft2(white * size[:, None] * size[: CELLS // 2 + 1], s=(CELLS, CELLS))
