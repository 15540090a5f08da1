# SPDX-License-Identifier: MIT
"""Sine, cosine, logarithm and inverse hyperbolic sine of floats or `Lanes`, without branches.

The polynomials are those of FreeBSD's msun (k_sin.c, k_cos.c, k_log.h: Copyright (C) 1993 by Sun
Microsystems, permission to use, copy, modify and distribute freely granted). Results are within
some units in the last place of the exact ones.
"""

import numpy as np

from model.compiled import inlined
from model.lanes import exponent_and_mantissa, floor, nearest, root, select

# pi/2 in three parts; products of the first two by whole numbers below 2^20 are exact
HALF_PI = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
SIN = (
    -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
    2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10,
)  # fmt: skip
COS = (
    4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
    -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11,
)  # fmt: skip
LN2 = (6.93147180369123816490e-01, 1.90821492927058770002e-10)  # high and low part
LOG = (
    6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
    2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
    1.479819860511658591e-01,
)  # fmt: skip


@inlined
def sin_cos(x):
    """Compute sine and cosine of an angle below 10^6 rad in size.

    Args:
        x: Angle, a float or `Lanes` [rad].

    Returns:
        Sine and cosine.
    """
    quarter = nearest(x * (2 / np.pi))
    r = x - quarter * HALF_PI[0]
    r = r - quarter * HALF_PI[1]
    r = r - quarter * HALF_PI[2]
    z = r * r
    s = z * (SIN[2] + z * (SIN[3] + z * (SIN[4] + z * SIN[5])))
    s = r + r * z * (SIN[0] + z * SIN[1] + z * s)
    c = z * (COS[2] + z * (COS[3] + z * (COS[4] + z * COS[5])))
    c = 1.0 - (0.5 * z - z * z * (COS[0] + z * COS[1] + z * c))
    quadrant = quarter - 4.0 * floor(quarter * 0.25)
    odd = (quadrant == 1.0) | (quadrant == 3.0)
    sine, cosine = select(odd, c, s), select(odd, s, c)
    sine = select(quadrant >= 2.0, -sine, sine)
    return sine, select((quadrant == 1.0) | (quadrant == 2.0), -cosine, cosine)


@inlined
def log_of(x):
    """Compute the natural logarithm of a positive normal float or of `Lanes` of them."""
    exponent, mantissa = exponent_and_mantissa(x)
    return _log(exponent, mantissa - 1.0)


@inlined
def arsinh(x):
    """Compute the inverse hyperbolic sine of a float or `Lanes`, not negative and below 10^150.

    It is log(1 + y) with y = x + x^2 / (1 + sqrt(1 + x^2)). Near zero y itself is used, not what is
    left of it in 1 + y, which keeps the relative accuracy.
    """
    y = x + x * x / (1.0 + root(1.0 + x * x))
    exponent, mantissa = exponent_and_mantissa(1.0 + y)
    return _log(exponent, select(exponent == 0.0, y, mantissa - 1.0))


@inlined
def _log(exponent, f):
    """Compute the logarithm of 2^exponent (1 + f), with 1 + f from sqrt(1/2) to sqrt(2)."""
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    even = w * (LOG[1] + w * (LOG[3] + w * LOG[5]))
    odd = z * (LOG[0] + w * (LOG[2] + w * (LOG[4] + w * LOG[6])))
    half = 0.5 * f * f
    return exponent * LN2[0] - ((half - (s * (half + even + odd) + exponent * LN2[1])) - f)
