# SPDX-License-Identifier: MIT
"""Switches of the thesis's walking model, which a walk is asked for with."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ThesisSwitches:
    """What the thesis's model does as its listing has it, or otherwise.

    Attributes:
        reset_height: Set the body's height at every change of contacts, as the listing does; the
            text's figures were made without, and sink.
        mend_roll: Reverse the roll in right turns; the thesis's height difference is inner less
            outer for both directions, which leans a right turn the wrong way.
        mend_slip: Give slip the sign of the equations where legs turn back or the body goes
            backward, instead of the listing's; see `walk_slip` and `lateral_walk_slip`.
        mend_heading: Let roll, pitch and inertia turn with the body's heading, R = Rz Rx Ry,
            instead of Eq. (3-7), R = Rx Ry Rz, by which the walk depends on the compass.
        static_loads: Take the legs' normal forces from static equilibrium, Eq. (4-18), without the
            optimisation of section 4-4-2; height, roll and pitch then follow the hips' kinematics.
        contact_slip_angle: Take the slip angle from the velocity of each contact, as Eq. (4-41)
            of section 4-5-3 prints, instead of the body's, as Listing A.21 does.
        heading: Yaw at the start; without `mend_heading` the walk depends on it [rad].
    """

    reset_height: bool = True
    mend_roll: bool = False
    mend_slip: bool = False
    mend_heading: bool = False
    static_loads: bool = False
    contact_slip_angle: bool = False
    heading: float = 0.0


AS_LISTED = ThesisSwitches()
"""The model as its listing has it."""
