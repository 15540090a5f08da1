# SPDX-License-Identifier: MIT
"""A step of the thesis's model in the frame of the body's heading, which mends its compass.

Eq. (3-7) rolls about an axis fixed to the ground, and the model takes the rates of its angles for
an angular velocity in the inertial frame while the inertia does not turn. For a robot that heads
along x all of this is right as long as it does not yaw; so a mended step is computed as that of
such a robot, with roll and pitch, their rates and the inertia turning with the heading.
"""

import numpy as np

from model.compiled import compiled


@compiled
def to_heading(mended, q, v, centre_before, here, rates, turning, before):
    """Express the state in the frame of the heading, with its origin below the body's centre.

    Args:
        mended: Whether to do so; otherwise the state is copied.
        q: Coordinates x, y, z [m], roll, pitch and yaw [rad], shape (6,).
        v: Rates of the coordinates, shape (6,) [m/s, rad/s].
        centre_before: Position of the body one step ago, shape (3,) [m].
        here: Filled: the coordinates; x, y and yaw zero in the frame of the heading, (6,).
        rates: Filled: their rates, shape (6,) [m/s, rad/s].
        turning: Filled: rates by which the legs' planes tilt; the rate of yaw is zero in the frame
            of the heading, which turns with the body, shape (6,) [m/s, rad/s].
        before: Filled: position of the body one step ago, shape (3,) [m].
    """
    for i in range(6):  # slices would take longer to compile than all the rest
        here[i], rates[i], turning[i] = q[i], v[i], v[i]
    for a in range(3):
        before[a] = centre_before[a]
    if not mended:
        return
    c, s = np.cos(q[5]), np.sin(q[5])
    rates[0], rates[1] = c * v[0] + s * v[1], c * v[1] - s * v[0]
    dx, dy = centre_before[0] - q[0], centre_before[1] - q[1]
    before[0], before[1] = c * dx + s * dy, c * dy - s * dx
    here[0], here[1], here[5], turning[5] = 0.0, 0.0, 0.0, 0.0


@compiled
def from_heading(mended, yaw, here, rates, q, v):
    """Express a state in the inertial frame again; the inverse of `to_heading`.

    Args:
        mended: Whether `here` and `rates` are in the frame of the heading.
        yaw: Yaw of that frame [rad].
        here: Coordinates in that frame, of which height, roll and pitch are used, (6,) [m, rad].
        rates: Their rates, shape (6,) [m/s, rad/s].
        q: Coordinates; height, roll and pitch are overwritten, shape (6,) [m, rad].
        v: Filled: rates of the coordinates, shape (6,) [m/s, rad/s].
    """
    for i in range(2, 5):
        q[i] = here[i]
    for i in range(6):
        v[i] = rates[i]
    if mended:
        c, s = np.cos(yaw), np.sin(yaw)
        v[0], v[1] = c * rates[0] - s * rates[1], s * rates[0] + c * rates[1]
