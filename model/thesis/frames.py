# SPDX-License-Identifier: MIT
"""The hip frames H and contact frames C of a walk by the thesis's model, section 3-3."""

import numpy as np

from model.arrays import Array
from model.frames import attitude, rotation_y, rotation_z
from model.leg import contact_angle, contact_in_body
from model.robot import Robot
from model.thesis.path import ThesisPath


def hip_frames(robot: Robot, path: ThesisPath) -> Array:
    r"""Compute the transforms from hip to inertial frame, H_B^I H_H^B of Eq. (3-8) and (3-11).

    .. math::
        H_{H_i}^I = \begin{bmatrix} R_B R_y(\theta_i) & p_b + R_B\,p_{h_i} \\ 0 & 1 \end{bmatrix}

    The x axis of the hip frame points to the centre of the leg's arc; of a half circle to its toe.

    Args:
        robot: The robot that walked.
        path: The walk, of n samples.

    Returns:
        Homogeneous transforms, shape (n, 6, 4, 4); positions in m.
    """
    body = attitude(*path.orientation.T)[:, None]
    return _transforms(body @ rotation_y(path.theta), _on_body(path, robot.hips))


def contact_frames(robot: Robot, path: ThesisPath) -> Array:
    r"""Compute the transforms from contact to inertial frame, at each leg's lowest point.

    .. math::
        R_{C_i}^I = R_z(\theta_y) R_y(\theta_i + \varphi_i - \pi/2)

    as in Listing A.4: x points along the heading. The text's Eq. (3-14) goes through the body and
    takes its roll off again, which gives the same for a body without pitch that heads along x.

    Args:
        robot: The robot that walked.
        path: The walk, of n samples.

    Returns:
        Homogeneous transforms, shape (n, 6, 4, 4); positions in m.
    """
    lowest = contact_angle(path.phi, robot.toe_beyond)
    x, z = contact_in_body(path.theta, lowest, robot.leg_radius)
    leg = robot.hips + np.stack([np.asarray(x), np.zeros_like(path.phi), np.asarray(z)], axis=-1)
    return _transforms(_contact_axes(path), _on_body(path, leg))


def contact_forces(path: ThesisPath) -> Array:
    """Compute the force of the ground on each leg in the inertial frame, Eq. (4-1), (n, 6, 3) [N].

    Args:
        path: The walk, of n samples.
    """
    along_axes = np.concatenate([path.traction_force, path.normal_force[..., None]], axis=-1)
    return np.squeeze(_contact_axes(path) @ along_axes[..., None], -1)


def _on_body(path: ThesisPath, points: Array) -> Array:
    """Transform points of the body, shape (..., 6, 3), to the inertial frame, (n, 6, 3) [m]."""
    body = attitude(*path.orientation.T)[:, None]
    return path.position[:, None] + np.squeeze(body @ points[..., None], -1)


def _contact_axes(path: ThesisPath) -> Array:
    """Compute the rotations from contact to inertial frame, shape (n, 6, 3, 3)."""
    lean = path.theta + path.phi - np.pi / 2
    return rotation_z(path.angles[:, 2])[:, None] @ rotation_y(lean)


def _transforms(rotation: Array, origin: Array) -> Array:
    """Return homogeneous transforms, (..., 4, 4), of rotations, (..., 3, 3), and origins."""
    H = np.zeros((*origin.shape[:-1], 4, 4))
    H[..., :3, :3], H[..., :3, 3], H[..., 3, 3] = rotation, origin, 1.0
    return H
