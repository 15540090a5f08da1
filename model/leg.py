# SPDX-License-Identifier: MIT
r"""A leg: an arc of a circle from its hip to its toe, and the lowest point on it.

Points of the leg's full circle, Eq. (3-17), are named by an angle phi, in the hip frame

.. math::
    L(\varphi) = (r + r\cos\varphi,\ 0,\ -r\sin\varphi) .

The hip is at phi = pi; the arc ends in its toe at phi = -(arc - pi), which is 0 for the thesis's
half circle. The lowest point of the full circle is at `phi`; the lowest point of the leg, its
potential contact, at `contact_angle(phi)`, which differs where phi lies beyond the toe or the hip.

Every function takes numbers or arrays that broadcast, and works inside compiled loops too: for
their sake arguments are positional, and cases are sums of terms times truth values.
"""

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from model.arrays import Numbers

HIP, ROLLING, TOE = 0, 1, 2  # leg states


def wrap_angle(angle: Numbers) -> Numbers:
    """Wrap an angle into (-pi, pi] [rad]."""
    return np.pi - (np.pi - angle) % (2 * np.pi)


def thesis_tilt(roll: Numbers, pitch: Numbers, yaw: Numbers) -> Numbers:
    r"""Compute the thesis's tilt X, the slope of the legs' planes along the heading [-].

    .. math::
        X = \frac{\tan\theta_r \sin\theta_y}{\cos\theta_p} - \tan\theta_p \cos\theta_y

    The brackets of Eq. (3-21), with angles of Eq. (3-7), R = Rx(roll) Ry(pitch) Rz(yaw). Listing
    A.22 computes this; the text lost the division by cos(pitch), without which phi is not at the
    lowest point while a robot pitches, rolls and does not head along x or y.

    Args:
        roll: Roll of Eq. (3-7) [rad].
        pitch: Pitch of Eq. (3-7) [rad].
        yaw: Yaw of Eq. (3-7) [rad].
    """
    return np.tan(roll) * np.sin(yaw) / np.cos(pitch) - np.tan(pitch) * np.cos(yaw)


def thesis_tilt_rate(
    roll: Numbers,
    pitch: Numbers,
    yaw: Numbers,
    roll_rate: Numbers,
    pitch_rate: Numbers,
    yaw_rate: Numbers,
) -> Numbers:
    r"""Compute the time derivative of `thesis_tilt`, the numerator of Eq. (3-24) [1/s].

    .. math::
        \dot X = \dot\theta_r \frac{\sin\theta_y}{\cos\theta_p} (1 + \tan^2\theta_r)
               - \dot\theta_p (\cos\theta_y (1 + \tan^2\theta_p)
                   - \tan\theta_r \sin\theta_y \frac{\tan\theta_p}{\cos\theta_p})
               + \dot\theta_y (\tan\theta_r \frac{\cos\theta_y}{\cos\theta_p}
                   + \tan\theta_p \sin\theta_y)

    Eq. (3-24), and Listing A.23 with it, is the special case of no pitch (or no roll).

    Args:
        roll: Roll of Eq. (3-7) [rad].
        pitch: Pitch of Eq. (3-7) [rad].
        yaw: Yaw of Eq. (3-7) [rad].
        roll_rate: Rate of the roll [rad/s].
        pitch_rate: Rate of the pitch [rad/s].
        yaw_rate: Rate of the yaw [rad/s].
    """
    slope, sine, cosine = np.tan(roll) / np.cos(pitch), np.sin(yaw), np.cos(yaw)
    tan_pitch = np.tan(pitch)
    return (
        roll_rate * sine * (1 + np.tan(roll) ** 2) / np.cos(pitch)
        - pitch_rate * (cosine * (1 + tan_pitch**2) - slope * sine * tan_pitch)
        + yaw_rate * (slope * cosine + tan_pitch * sine)
    )


def thesis_lowest_angle(theta: Numbers, tilt: Numbers) -> Numbers:
    r"""Compute phi_min, angle of the lowest point of a leg's circle, Eq. (3-21), (3-23) [rad].

    .. math::
        \tan\varphi = \frac{1 + \tan\theta\,X}{\tan\theta - X}, \qquad
        \frac{d^2 z}{d\varphi^2} > 0
        \quad\Longleftrightarrow\quad \varphi = \frac{\pi}{2} - \theta + \arctan X

    The tangent is that of a difference, so its arctangent and the choice of the quadrant by the
    second derivative come to one sum, as long as the body is not upside down.

    Args:
        theta: Leg angle [rad].
        tilt: X of `thesis_tilt` [-].

    Returns:
        phi_min in (-pi, pi].
    """
    return wrap_angle(np.pi / 2 - theta + np.arctan(tilt))


def thesis_lowest_angle_rate(leg_speed: Numbers, tilt: Numbers, tilt_rate: Numbers) -> Numbers:
    r"""Compute the time derivative of phi_min, `thesis_lowest_angle`, Eq. (3-24) [rad/s].

    .. math::
        \dot\varphi = \frac{\dot X}{1 + X^2} - \dot\theta

    Args:
        leg_speed: Rate of the leg angle [rad/s].
        tilt: Tilt X, `thesis_tilt` [-].
        tilt_rate: Rate of the tilt, `thesis_tilt_rate` [1/s].
    """
    return tilt_rate / (1 + tilt**2) - leg_speed


def lowest_angle(theta: Numbers, roll: Numbers, pitch: Numbers) -> Numbers:
    r"""Compute the angle phi of the lowest point of a leg's full circle from leg angle and tilt.

    .. math::
        \varphi = \frac{\pi}{2} - \theta - \arctan\frac{\tan\theta_p}{\cos\theta_r}

    With R = Rz(yaw) Ry(pitch) Rx(roll) phi does not depend on the heading; the thesis's does
    (`thesis_lowest_angle`), because its roll turns about an axis fixed to the ground. Written with
    the arctangent of two arguments, it holds upside down too; with the leg's plane level (a roll of
    90 degrees) no point is lowest, and phi is arbitrary.

    Args:
        theta: Leg angle [rad].
        roll: Roll of `model.frames.attitude` [rad].
        pitch: Pitch of `model.frames.attitude` [rad].

    Returns:
        phi in (-pi, pi] [rad].
    """
    downhill = np.arctan2(np.sin(pitch), np.cos(pitch) * np.cos(roll))
    return wrap_angle(np.pi / 2 - theta - downhill)


def plane_cosine(roll: Numbers, pitch: Numbers) -> Numbers:
    r"""Compute the cosine of the angle between the legs' planes and the vertical [-].

    .. math::
        \sqrt{\sin^2\theta_p + \cos^2\theta_p \cos^2\theta_r}

    Heights measured in a leg's plane are to be multiplied by it. The thesis takes
    :math:`\cos\theta_r`, which is the same without pitch.

    Args:
        roll: Roll [rad].
        pitch: Pitch [rad].
    """
    return np.sqrt(np.sin(pitch) ** 2 + (np.cos(pitch) * np.cos(roll)) ** 2)


def leg_state(phi: Numbers, toe_beyond: float = 0.0) -> NDArray[np.int_] | int:
    """Classify the part of a leg that is lowest: HIP (0), ROLLING (1) or TOE (2), section 3-4-1.

    A leg rolls where phi lies on its arc. Beyond the arc's ends the nearer end is the lower one;
    for the thesis's half circle that is the toe for phi from -pi/2 to 0, the hip below -pi/2.

    Args:
        phi: Angle of the circle's lowest point, in (-pi, pi] [rad].
        toe_beyond: Angle of the arc beyond a half circle, negative for a shorter arc [rad].

    >>> import numpy as np
    >>> leg_state(np.array([2.0, 0.0, -0.1, -1.6])).tolist()
    [1, 1, 2, 0]
    """
    between = -(np.pi + toe_beyond) / 2
    toe = (phi < -toe_beyond) & (phi >= between)
    return ROLLING * (phi >= -toe_beyond) + TOE * toe


def contact_angle(phi: Numbers, toe_beyond: float = 0.0) -> Numbers:
    """Compute the angle of a leg's lowest point: phi on its arc, -toe_beyond (toe), pi (hip) [rad].

    Which of the three it is, `leg_state` says.

    Args:
        phi: Angle of the circle's lowest point, in (-pi, pi] [rad].
        toe_beyond: Angle of the arc beyond a half circle, negative for a shorter arc [rad].
    """
    between = -(np.pi + toe_beyond) / 2
    toe = (phi < -toe_beyond) & (phi >= between)
    return (phi >= -toe_beyond) * phi - toe * toe_beyond + (phi < between) * np.pi


def contact_in_body(theta: Numbers, contact: Numbers, radius: float) -> tuple[Numbers, Numbers]:
    r"""Compute the position of a leg's point from its hip in body axes, Eq. (3-12), (3-15).

    .. math::
        x = r\,(\cos\theta + \cos(\theta + \varphi_c)), \qquad
        z = -r\,(\sin\theta + \sin(\theta + \varphi_c))

    Args:
        theta: Leg angle [rad].
        contact: Angle phi_c of the point on the leg, from `contact_angle` [rad].
        radius: Radius of the arc [m].

    Returns:
        x (forward) and z (up); y is zero [m].
    """
    x = radius * (np.cos(theta) + np.cos(theta + contact))
    z = -radius * (np.sin(theta) + np.sin(theta + contact))
    return x, z


def hip_height(phi: Numbers, radius: float, toe_beyond: float = 0.0) -> Numbers:
    r"""Compute the height of a hip above its leg's lowest point, in the leg's plane [m].

    .. math::
        z_h = r\,(\cos\varphi + \cos(\varphi - \varphi_c)) =
        \begin{cases} r + r\cos\varphi & \text{rolling} \\ 2 r \cos\varphi & \text{toe of a half
        circle} \\ 0 & \text{hip} \end{cases}

    with phi_c = `contact_angle(phi)`: Eq. (3-37) without its factor :math:`\cos\theta_r`, for any
    arc; see `plane_cosine`.

    Args:
        phi: Angle of the circle's lowest point, in (-pi, pi] [rad].
        radius: Radius of the arc [m].
        toe_beyond: Angle of the arc beyond a half circle [rad].

    >>> import numpy as np
    >>> hip_height(np.radians([40.0, -28.0]), 0.035).round(5).tolist()
    [0.06181, 0.06181]
    """
    return radius * (np.cos(phi) + np.cos(phi - contact_angle(phi, toe_beyond)))


def hip_height_rate(
    phi: Numbers, phi_rate: Numbers, radius: float, toe_beyond: float = 0.0
) -> Numbers:
    r"""Compute the time derivative of `hip_height`, Eq. (3-38) without its cos(roll) [m/s].

    .. math::
        \dot z_h = -r \dot\varphi\,(\sin\varphi + \sin(\varphi - \varphi_c)), \qquad
        \varphi_c = \texttt{contact\_angle}(\varphi)

    Args:
        phi: Angle of the lowest point of the leg's full circle [rad].
        phi_rate: Rate of phi [rad/s].
        radius: Radius of the leg's arc [m].
        toe_beyond: Angle of the arc beyond a half circle [rad].
    """
    return -radius * phi_rate * (np.sin(phi) + np.sin(phi - contact_angle(phi, toe_beyond)))


def hip_height_acceleration(
    phi: Numbers, phi_rate: Numbers, radius: float, toe_beyond: float = 0.0
) -> Numbers:
    r"""Compute the second derivative of `hip_height` at constant rate of phi, Eq. (3-39) [m/s2].

    .. math::
        \ddot z_h = -r \dot\varphi^2\,(\cos\varphi + [\text{not rolling}]\cos(\varphi - \varphi_c))

    with phi_c = `contact_angle(phi)`. While the leg rolls its contact moves along the arc with phi,
    so the second term is zero; on the toe and on the hip [not rolling] is 1.

    Args:
        phi: Angle of the lowest point of the leg's full circle [rad].
        phi_rate: Rate of phi [rad/s].
        radius: Radius of the leg's arc [m].
        toe_beyond: Angle of the arc beyond a half circle [rad].
    """
    off_arc = phi < -toe_beyond
    turning = np.cos(phi) + off_arc * np.cos(phi - contact_angle(phi, toe_beyond))
    return -radius * phi_rate**2 * turning


for _function in (
    wrap_angle,
    thesis_tilt,
    thesis_tilt_rate,
    thesis_lowest_angle,
    thesis_lowest_angle_rate,
    lowest_angle,
    plane_cosine,
    leg_state,
    contact_angle,
    contact_in_body,
    hip_height,
    hip_height_rate,
    hip_height_acceleration,
):
    register_jitable(_function)  # a plain function in Python, inlined where compiled code calls it
