# SPDX-License-Identifier: MIT
"""Hip and contact frames of a walk against the chain of transforms of section 3-3."""

import numpy as np
import pytest

from model.frames import body_from_hip, hip_from_contact, thesis_attitude, transform
from model.gait.steering import tripod_angles, tripod_reference
from model.leg import contact_angle
from model.robot import Robot
from model.thesis.frames import contact_forces, contact_frames, hip_frames
from model.thesis.legs import SwitchedLegs
from model.thesis.walk import ThesisOptions, walk_thesis

ROBOT = Robot()
LEGS = SwitchedLegs.of(tripod_reference(tripod_angles(np.radians(45.0), 1.25), 1.0))


@pytest.fixture(scope="module")
def path():
    options = ThesisOptions(heading=0.4)
    return walk_thesis(ROBOT, LEGS, duration=2.0, options=options)


def chain(path, sample, leg):
    """Return H_H^I and H_C^I of one leg by Eq. (3-5), with the angles of Eq. (3-7)."""
    body = transform(thesis_attitude(*path.angles[sample]), path.position[sample])
    hip = body @ body_from_hip(float(path.theta[sample, leg]), ROBOT.hips[leg])
    phi = float(path.phi[sample, leg])
    lowest = float(contact_angle(phi, ROBOT.toe_beyond))
    own = hip_from_contact(phi, lowest, roll=path.angles[sample, 0], radius=ROBOT.leg_radius)
    return hip, hip @ own


@pytest.mark.parametrize("sample", [3, 11, 30])
def test_frames_are_linked_as_in_the_text(path, sample):
    hips, contacts = hip_frames(ROBOT, path), contact_frames(ROBOT, path)
    for leg in range(6):
        hip, contact = chain(path, sample, leg)
        np.testing.assert_allclose(hips[sample, leg], hip, atol=1e-9)
        np.testing.assert_allclose(contacts[sample, leg, :3, 3], contact[:3, 3], atol=1e-9)


def test_contact_frames_are_level_and_point_along_the_heading(path):
    axes = contact_frames(ROBOT, path)[..., :3, :3]
    yaw = path.angles[:, 2]
    np.testing.assert_allclose(axes[..., 2, 2], 1.0, atol=2e-3)
    ahead = np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)[:, None]
    np.testing.assert_allclose(axes[..., :2, 0], np.broadcast_to(ahead, (*yaw.shape, 6, 2)),
                               atol=2e-3)  # fmt: skip


def test_hips_are_their_height_above_the_contacts(path):
    rise = hip_frames(ROBOT, path)[..., 2, 3] - contact_frames(ROBOT, path)[..., 2, 3]
    np.testing.assert_allclose(rise, path.hip_height, atol=1e-4)


def test_contact_forces_accelerate_the_body():
    path = walk_thesis(ROBOT, LEGS, duration=0.5)
    force = contact_forces(path).sum(axis=1) / ROBOT.mass
    np.testing.assert_allclose(force[:, :2], path.acceleration[:, :2], atol=1e-6)
    np.testing.assert_allclose(force[:, 2] - 9.81, path.acceleration[:, 2], atol=1e-6)
