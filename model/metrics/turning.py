# SPDX-License-Identifier: MIT
"""Turning radius and yaw rate of a path, from poses at any times."""

import numpy as np

from model.poses import Poses

ROUND = 0.2  # of the positions' spread, that the misfit of a circle may have
STILL = 1e-12  # rad; a smaller range of headings is rounding
STRAIGHT = np.radians(5.0)  # range of headings; below, a radius is mostly the tracker's noise


def mean_yaw_rate(poses: Poses) -> float:
    """Fit a line to heading over time by least squares; return its slope, positive left [rad/s].

    Exactly 0 if the heading stands still; NaN if a heading is missing or there are fewer than two
    poses.
    """
    if not poses.has_yaw or len(poses) < 2:
        return float("nan")
    if np.ptp(poses.yaw) < STILL:
        return 0.0
    t = poses.t - poses.t.mean()
    return float(t @ (poses.yaw - poses.yaw.mean()) / (t @ t))


def fitted_radius(poses: Poses) -> float:
    r"""Compute the turning radius by a fitted circle, with a constant angle from heading to path.

    .. math::
        p_i = c + a (\sin\psi_i, -\cos\psi_i) + b (\cos\psi_i, \sin\psi_i)

    for position p_i and heading psi_i; linear least squares over centre c, a and b. The radius is
    :math:`\sqrt{a^2 + b^2}` with the sign of a, and b/a is the tangent of the angle from the
    heading to the path. Holds for any turn, also beyond a full one, where the chord between the
    first and the last pose is of no use. An S-curve, or a turn between two straights, is no circle
    and has no radius: the misfit, root mean square, is then more than a fifth of the positions'
    root mean square distance from their mean.

    Args:
        poses: One path of four or more poses.

    Returns:
        Radius, positive for a left turn; plus infinity if the headings span less than 5 degrees;
        NaN if the path is no circle, a heading is missing or there are fewer than four poses [m].
    """
    if not poses.has_yaw or len(poses) < 4:
        return float("nan")
    if np.ptp(poses.yaw) < STRAIGHT:
        return float("inf")
    c, s = np.cos(poses.yaw), np.sin(poses.yaw)
    one, zero = np.ones_like(c), np.zeros_like(c)
    design = np.vstack([np.column_stack([one, zero, s, c]), np.column_stack([zero, one, -c, s])])
    places = poses.position.T.ravel()
    fit = np.linalg.lstsq(design, places, rcond=None)[0]
    misfit = np.linalg.norm(places - design @ fit)
    if misfit > ROUND * np.linalg.norm(poses.position - poses.position.mean(axis=0)):
        return float("nan")
    _, _, a, b = fit
    return float(np.copysign(np.hypot(a, b), a))
