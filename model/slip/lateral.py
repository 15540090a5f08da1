# SPDX-License-Identifier: MIT
"""Lateral slip of the thesis: a slip angle, scaled to replace a slip ratio."""

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array


def slip_angle(velocity_x: ArrayLike, velocity_y: ArrayLike) -> Array:
    r"""Compute the slip angle of Eq. (4-41), with the sign of the thesis's listing.

    .. math::
        \tan\alpha = -\frac{{}^C\dot y}{{}^C\dot x}

    The text prints Eq. (4-41) without the minus; its own Eq. (4-30) and its listing have it, and
    only with it does a force D·sin(…alpha…) oppose the sliding. For a contact moving backwards it
    points along the sliding, since an arctangent of the quotient loses the sign, as in the thesis.

    Args:
        velocity_x: Velocity along the heading, in the contact frame [m/s]. The text takes the
            contact point's, Eq. (4-35); the listing the body's.
        velocity_y: Velocity to the left, in the contact frame [m/s].

    Returns:
        Slip angle in [-pi/2, pi/2], positive when sliding to the right while moving forward;
        -sgn(velocity_y)·pi/2 where velocity_x is zero, and zero where both are [rad].

    >>> float(slip_angle(0.1, -0.1).round(4))
    0.7854
    """
    v_x, v_y = np.asarray(velocity_x, dtype=float), np.asarray(velocity_y, dtype=float)
    forward = np.where(v_x < 0, -1.0, 1.0)  # arctan2 on the half plane where it is arctan(y/x)
    return np.arctan2(-v_y * forward, np.abs(v_x))


def lateral_slip(alpha: ArrayLike) -> Array:
    r"""Compute the lateral slip ratio that replaces kappa in Eq. (4-23), Eq. (4-42).

    .. math::
        \kappa_\alpha = \frac{\alpha}{\pi/2}

    The thesis's heuristic, never measured: sideways sliding (pi/2) is to count as much as
    spinning on the spot (1). It is neither tan(alpha), Pacejka's lateral slip, nor alpha, what
    Eq. (4-24) takes.

    Args:
        alpha: Slip angle, from -pi/2 to pi/2 [rad].

    Returns:
        Lateral slip ratio, from -1 to 1 [-].
    """
    return np.asarray(alpha, dtype=float) / (np.pi / 2)
