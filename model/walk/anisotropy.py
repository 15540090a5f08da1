# SPDX-License-Identifier: MIT
r"""Traction of a leg that differs along and across its rolling direction, compiled.

With a the lateral over the longitudinal grip and b the lateral over the longitudinal slip
stiffness, slip velocity :math:`(s_x, s_y)` along and across the rolling direction, and the secant
G of the isotropic law, :math:`F(s) = -G(|s|)\, s`,

.. math::
    s' = (s_x,\ \tfrac{b}{a}\, s_y), \qquad (F_x, F_y) = (F_x(s'),\ a\, F_y(s'))
    = -G(|s'|)\, (s_x,\ b\, s_y) .

Pure lateral slip has a times the peak and b times the slope of longitudinal slip. Traction takes
energy out of any slip, :math:`F \cdot s = -G\, (s_x^2 + b\, s_y^2)`. The ends of all forces of one
load lie within an ellipse. Corners of the body have no rolling direction; their traction is the
same in all directions.
"""

import numpy as np

from model.compiled import inlined
from model.robot import N_LEGS

ALONG_ONLY = 1e-6  # least part of the body's y axis along the ground that has a direction


@inlined
def find_across(law, work, i):
    """Fill `across` and `lateral` of contact i from its normal and the body's rotation.

    `lateral` is (b - 1, (b / a)^2 - 1); zero for an isotropic law, a corner of the body, or a body
    on its side. `across` is then left as it is.

    Args:
        law: The contact's slip law.
        work: Arrays of the step, with the rotation and the contact's normal.
        i: Index of the contact.
    """
    a, b = law.lateral_grip, law.lateral_stiffness
    work.lateral[i, 0], work.lateral[i, 1] = 0.0, 0.0
    if i >= N_LEGS or (a == 1.0 and b == 1.0):
        return
    R, m, across = work.R, work.normal[i], work.across[i]
    up = R[0, 1] * m[0] + R[1, 1] * m[1] + R[2, 1] * m[2]
    size = 0.0
    for k in range(3):
        across[k] = R[k, 1] - up * m[k]
        size += across[k] ** 2
    if size < ALONG_ONLY**2:
        return
    for k in range(3):
        across[k] /= np.sqrt(size)
    work.lateral[i, 0], work.lateral[i, 1] = b - 1.0, (b / a) ** 2 - 1.0


@inlined
def effective_size(lateral, across, x, y, z):
    """Compute |s'|, the slip speed at which the isotropic law is evaluated [m/s].

    Args:
        lateral: b - 1 and (b / a)^2 - 1, shape (2,).
        across: Unit vector across the rolling direction, world frame, shape (3,).
        x: x of the slip velocity along the ground, world frame [m/s].
        y: y of the slip velocity [m/s].
        z: z of the slip velocity [m/s].
    """
    square = x * x + y * y + z * z
    if lateral[1] != 0.0:
        square += lateral[1] * (x * across[0] + y * across[1] + z * across[2]) ** 2
    return np.sqrt(square)


@inlined
def sideways(lateral, across, vector):
    """Compute (b - 1) times the component of a slip velocity across the rolling direction [m/s].

    Traction is -G times the sum of the slip velocity and this number times `across`.

    Args:
        lateral: b - 1 and (b / a)^2 - 1, shape (2,).
        across: Unit vector across the rolling direction, world frame, shape (3,).
        vector: Slip velocity along the ground, world frame, shape (3,) [m/s].
    """
    if lateral[0] == 0.0:
        return 0.0
    return lateral[0] * (vector[0] * across[0] + vector[1] * across[1] + vector[2] * across[2])
