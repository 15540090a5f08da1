# SPDX-License-Identifier: MIT
"""The true load from measured forces, which inverts the simulated normal channel."""

from model.arrays import Array
from rig.slip_rig.imperfections import RigImperfections


def true_load(
    normal_force: Array, traction_force: Array, *, imperfections: RigImperfections
) -> Array:
    r"""Compute the true load from both measured forces.

    .. math::
        F_n = (1 + g_n)\,F_{n,measured} - b_n + c\,F_t

    Args:
        normal_force: Measured normal force [N].
        traction_force: Measured traction force F_t [N].
        imperfections: Carries g_n, b_n and c.

    Returns:
        True normal force [N].
    """
    return (
        (1 + imperfections.gain_normal) * normal_force
        - imperfections.bias_normal
        + imperfections.crosstalk * traction_force
    )
