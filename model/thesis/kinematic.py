# SPDX-License-Identifier: MIT
"""The thesis's quantities of a walk whose kinematics alone are known, as of its tetrapod."""

import numpy as np

from model.arrays import Array
from model.frames import attitude
from model.leg import (
    contact_angle,
    contact_in_body,
    hip_height,
    thesis_lowest_angle,
    thesis_lowest_angle_rate,
    thesis_tilt,
    thesis_tilt_rate,
    wrap_angle,
)
from model.robot import Robot
from model.thesis.path import ThesisPath
from model.walk.path import WalkPath


def kinematic_path(robot: Robot, path: WalkPath) -> ThesisPath:
    """Compute the kinematic quantities of the thesis's model of a walk.

    Rates are differences between the samples before and after, so that they are large where roll
    and pitch jump with a change of contacts. Accelerations and static loads, which need forces,
    are NaN; static loads are zero without contact.

    Args:
        robot: The robot that walked.
        path: The walk, of three samples or more.
    """
    t, nothing = path.t, np.where(path.contact, np.nan, 0.0)
    angles = thesis_angles(path.orientation)
    rates = np.gradient(np.column_stack([path.position, angles]), t, axis=0)
    tilt = np.asarray(thesis_tilt(*angles.T))[:, None]
    tilt_rate = np.asarray(thesis_tilt_rate(*angles.T, *rates[:, 3:].T))[:, None]
    phi = np.asarray(thesis_lowest_angle(path.theta, tilt))
    turning = np.gradient(path.theta, t, axis=0)
    phi_rate = np.asarray(thesis_lowest_angle_rate(turning, tilt, tilt_rate))
    height = np.asarray(hip_height(phi, robot.leg_radius, robot.toe_beyond))
    x, z = contact_in_body(path.theta, contact_angle(phi, robot.toe_beyond), robot.leg_radius)
    contact = robot.hips + np.stack([x, np.zeros_like(phi), z], axis=-1)
    hip = np.broadcast_to(robot.hips, contact.shape)
    speeds = (-phi_rate * height, *(_forward(path, angles[:, 2], each) for each in (contact, hip)))
    leg_speed, contact_speed, hip_speed = (np.where(path.contact, v, np.nan) for v in speeds)
    return ThesisPath(
        **vars(path),
        angles=angles,
        rates=rates,
        acceleration=np.full(rates.shape, np.nan),
        phi=phi,
        phi_rate=phi_rate,
        hip_height=height,
        static_load=nothing,
        leg_speed=leg_speed,
        contact_speed=contact_speed,
        hip_speed=hip_speed,
    )


def thesis_angles(orientation: Array) -> Array:
    """Convert roll, pitch and yaw of `attitude` to those of Eq. (3-7), R = Rx Ry Rz.

    Args:
        orientation: Roll, pitch and unwrapped yaw, shape (n, 3) [rad].

    Returns:
        The thesis's angles, yaw unwrapped, shape (n, 3) [rad].
    """
    R, yaw = attitude(*orientation.T), orientation[:, 2]
    own = np.arctan2(-R[:, 0, 1], R[:, 0, 0])
    return np.column_stack([
        np.arctan2(-R[:, 1, 2], R[:, 2, 2]), np.arcsin(R[:, 0, 2]), yaw + wrap_angle(own - yaw)
    ])  # fmt: skip


def _forward(path: WalkPath, yaw: Array, point: Array) -> Array:
    """Compute the speed along the heading of points fixed to the body, shape (n, 6) [m/s].

    Args:
        path: The walk.
        yaw: Heading, shape (n,) [rad].
        point: Points in the body frame, shape (n, 6, 3) [m].
    """
    turning = np.gradient(attitude(*path.orientation.T), path.t, axis=0)
    v = np.gradient(path.position, path.t, axis=0)[:, None]
    v = v + np.squeeze(turning[:, None] @ point[..., None], -1)
    return np.cos(yaw)[:, None] * v[..., 0] + np.sin(yaw)[:, None] * v[..., 1]
