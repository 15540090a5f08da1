# SPDX-License-Identifier: MIT
"""Oscillation of the slip ratio when an explicit step meets a stiff slip law."""

import numpy as np

from model.walk.path import WalkPath


def largest_stable_step(speed: float, stiffness: float) -> float:
    r"""Compute the longest semi-implicit Euler step that does not chatter [s].

    With all contacts near zero slip, traction is stiffness times slip ratio, and the body's speed v
    relaxes to the legs' v_R by

    .. math::
        \frac{dv}{dt} = -\frac{s}{v}\,(v - v_R), \qquad s = B C D g / F_n

    a rate of s/v; the explicit step multiplies the difference by 1 - s dt / v, which is below -1
    beyond dt = 2 v / s.

    Args:
        speed: Walking speed v [m/s].
        stiffness: Traction over mass for each unit of slip, s; about 200 for the thesis's robot
            [m/s2].

    >>> from model.robot import GRAVITY
    >>> round(largest_stable_step(0.08, 34.34 * 1.564 * 0.3798 * GRAVITY), 5)
    0.0008
    """
    return 2 * speed / stiffness


def sign_changes_per_second(path: WalkPath) -> float:
    """Count changes of sign of the slip ratio for each second of contact of a leg [1/s].

    A path must hold every step: see `ThesisOptions.every`.
    """
    both = path.contact[1:] & path.contact[:-1]
    sign = np.sign(np.nan_to_num(path.slip_ratio))
    changes = np.count_nonzero((sign[1:] != sign[:-1]) & both)
    return changes / (np.count_nonzero(path.contact) * float(path.t[1] - path.t[0]))
