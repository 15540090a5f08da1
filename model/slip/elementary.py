# SPDX-License-Identifier: MIT
"""Elementary functions of floats or `Lanes`, without branches: sin, arctan, log and exp.

The polynomials are those of FreeBSD's msun (k_log.h, s_atan.c, e_exp.c: Copyright
(C) 1993 by Sun Microsystems, permission to use, copy, modify and distribute freely granted).
Results are within some units in the last place of the exact ones.
"""

import math

from model.compiled import inlined
from model.slip.lanes import exponent_and_mantissa, nearest, power_of_two, select, size

HALF_PI = 1.5707963267948966
LN2 = (6.93147180369123816490e-01, 1.90821492927058770002e-10)  # high and low part
LOG = (
    6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
    2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
    1.479819860511658591e-01,
)  # fmt: skip
ARCTAN = (
    3.33333333333329318027e-01, -1.99999999998764832476e-01, 1.42857142725034663711e-01,
    -1.11111104054623557880e-01, 9.09088713343650656196e-02, -7.69187620504482999495e-02,
    6.66107313738753120669e-02, -5.83357013379057348645e-02, 4.97687799461593236017e-02,
    -3.65315727442169155270e-02, 1.62858201153657823623e-02,
)  # fmt: skip
EXP = (
    1.66666666666666019037e-01, -2.77777777770155933842e-03, 6.61375632143793436117e-05,
    -1.65339022054652515390e-06, 4.13813679705723846039e-08,
)  # fmt: skip
SERIES = tuple((-1) ** n / math.factorial(2 * n + 1) for n in range(1, 11))  # of the sine
TAN_PI_8, TAN_3_PI_8 = 0.4142135623730950, 2.414213562373095
MOST_EXPONENT = 708.0  # the argument whose exponential is just below the largest float


@inlined
def sin_half_turn(x):
    """Compute the sine of an angle from -pi to pi, a float or `Lanes` [rad].

    It is that of the angle mirrored into -pi/2 to pi/2, by the series up to x^21.
    """
    x = select(x > HALF_PI, 2.0 * HALF_PI - x, x)
    x = select(x < -HALF_PI, -2.0 * HALF_PI - x, x)
    z = x * x
    w = z * z
    even = SERIES[1] + w * (SERIES[3] + w * (SERIES[5] + w * (SERIES[7] + w * SERIES[9])))
    odd = SERIES[0] + w * (SERIES[2] + w * (SERIES[4] + w * (SERIES[6] + w * SERIES[8])))
    return x + x * z * (odd + z * even)


@inlined
def arctan(x):
    """Compute the inverse tangent of a float or `Lanes` [rad]."""
    turned, r, less = _reduced_arctan(size(x))
    angle = turned + (r - less)
    return select(x < 0.0, -angle, angle)


@inlined
def minus_arctan(x):
    """Compute x - arctan(x) of a float or `Lanes`, to its full relative accuracy near zero too."""
    t = size(x)
    turned, r, less = _reduced_arctan(t)
    difference = select(turned > 0.0, t - (turned + (r - less)), less)
    return select(x < 0.0, -difference, difference)


@inlined
def _reduced_arctan(t):
    """Reduce an inverse tangent, arctan(t) = angle + arctan(r), to a small r; t is not negative.

    The angle is 0, pi/4 or pi/2, such that r is at most tan(pi/8) in size:
    arctan(t) = pi/4 + arctan((t - 1) / (t + 1)) = pi/2 + arctan(-1 / t).

    Returns:
        The angle, r and r - arctan(r).
    """
    middle, far = t > TAN_PI_8, t > TAN_3_PI_8
    above = select(far, -1.0, select(middle, t - 1.0, t))
    below = select(far, t, select(middle, t + 1.0, 1.0))
    r = above / below
    z = r * r
    w = z * z
    even = w * (ARCTAN[1] + w * (ARCTAN[3] + w * (ARCTAN[5] + w * (ARCTAN[7] + w * ARCTAN[9]))))
    odd = ARCTAN[4] + w * (ARCTAN[6] + w * (ARCTAN[8] + w * ARCTAN[10]))
    odd = z * (ARCTAN[0] + w * (ARCTAN[2] + w * odd))
    turned = select(far, HALF_PI, select(middle, 0.5 * HALF_PI, 0.0))
    return turned, r, r * (even + odd)


@inlined
def exp_of(x):
    """Compute the exponential of a float or `Lanes`, clipped to +-`MOST_EXPONENT`.

    x is split as k log(2) + r with whole k (Cody-Waite reduction): exp(x) = 2^k exp(r).
    """
    x = select(x > MOST_EXPONENT, MOST_EXPONENT, x)
    x = select(x < -MOST_EXPONENT, -MOST_EXPONENT, x)
    k = nearest(x * (1.0 / (LN2[0] + LN2[1])))
    high, low = x - k * LN2[0], k * LN2[1]
    r = high - low
    z = r * r
    c = r - z * (EXP[0] + z * (EXP[1] + z * (EXP[2] + z * (EXP[3] + z * EXP[4]))))
    return (1.0 - ((low - r * c / (2.0 - c)) - high)) * power_of_two(k)


@inlined
def log_of(x):
    """Compute the natural logarithm of a positive normal float or of `Lanes` of them.

    x is split as 2^exponent (1 + f), with 1 + f from sqrt(1/2) to sqrt(2).
    """
    exponent, mantissa = exponent_and_mantissa(x)
    f = mantissa - 1.0
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    even = w * (LOG[1] + w * (LOG[3] + w * LOG[5]))
    odd = z * (LOG[0] + w * (LOG[2] + w * (LOG[4] + w * LOG[6])))
    half = 0.5 * f * f
    return exponent * LN2[0] - ((half - (s * (half + even + odd) + exponent * LN2[1])) - f)
