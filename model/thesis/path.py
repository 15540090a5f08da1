# SPDX-License-Identifier: MIT
"""A path walked by the thesis's model, with the quantities of the model."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.walk.path import WalkPath


@dataclass(frozen=True, kw_only=True)
class ThesisPath(WalkPath):
    """A path with what the thesis's model computes besides, at every sample.

    A sample has the state before a step, and the legs' kinematics with it; rates, slip, speeds and
    forces are those of the step, after what a change of contacts sets.

    Attributes:
        angles: Roll, pitch and yaw of Eq. (3-7), R = Rx Ry Rz, of which `orientation` is
            computed, shape (n, 3) [rad].
        rates: Rates of x, y, z and of these angles, shape (n, 6) [m/s, rad/s].
        acceleration: Their change by the step's forces, over the step, (n, 6) [m/s2, rad/s2].
        phi: phi_min of Eq. (3-21), shape (n, 6) [rad].
        phi_rate: Its rate, Eq. (3-24), shape (n, 6) [rad/s].
        hip_height: Height of each hip above its leg's lowest point in the leg's plane, Eq. (3-37)
            without cos(roll), shape (n, 6) [m].
        static_load: Normal force in static equilibrium, Eq. (4-18), the listing's f_g; zero
            without contact, shape (n, 6) [N].
        leg_speed: v_R of Eq. (4-32), or v_T of Eq. (4-37) on the toe; NaN without contact,
            shape (n, 6) [m/s].
        contact_speed: v_C of Eq. (4-35), forward speed of the body's point at the contact; NaN
            without contact, shape (n, 6) [m/s].
        hip_speed: v_H of Eq. (4-40), forward speed of the hip; NaN without contact, (n, 6) [m/s].
    """

    angles: Array
    rates: Array
    acceleration: Array
    phi: Array
    phi_rate: Array
    hip_height: Array
    static_load: Array
    leg_speed: Array
    contact_speed: Array
    hip_speed: Array

    @property
    def is_kinematic(self) -> bool:
        """Whether no forces were computed: accelerations and static loads are NaN."""
        return bool(np.isnan(self.acceleration).all())
