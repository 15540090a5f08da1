# SPDX-License-Identifier: MIT
"""A walked path: pose of the body and state of each leg at every sample."""

from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.poses import Poses
from model.robot import N_LEGS
from model.walk.quaternion import roll_pitch_yaw


@dataclass(frozen=True)
class WalkPath:
    """Pose of the body and angle, slip and forces of each leg, at every sample of a walk.

    Attributes:
        t: Times, shape (n,) [s].
        position: Body centre in the inertial frame, shape (n, 3) [m].
        orientation: Roll, pitch and yaw, R = Rz(yaw) Ry(pitch) Rx(roll); yaw unwrapped,
            shape (n, 3) [rad].
        theta: Leg angles, shape (n, 6) [rad].
        contact: Whether each leg presses on the ground, shape (n, 6).
        slip_velocity: Velocity of each leg's material contact point over the ground, forward and
            to the left of the heading; zero in the air, NaN on the ground where a model has none,
            shape (n, 6, 2) [m/s].
        slip_ratio: Longitudinal slip ratio in the model's own definition; NaN in the air and
            where a model has none, as on the toe in the project's model, shape (n, 6) [-].
        normal_force: Normal force of the ground on each leg; zero in the air, NaN on the ground
            where a model has none, shape (n, 6) [N].
        traction_force: Traction force of the ground on each leg, forward and to the left of the
            heading; zero and NaN as `normal_force`, shape (n, 6, 2) [N].
        body_force: Normal force of the ground on the body itself; zero while it clears the ground,
            NaN where a model has none, shape (n,), or a number for all samples [N].
        energy: Since the walk began: work that the legs' motors did and took back, energy that slip
            and contacts took (`model.walk.leg_work`); NaN where a model has none, shape (n, 4), or
            a number for all [J].
    """

    t: Array
    position: Array
    orientation: Array
    theta: Array
    contact: NDArray[np.bool_]
    slip_velocity: Array
    slip_ratio: Array
    normal_force: Array
    traction_force: Array
    body_force: Array | float = np.nan
    energy: Array | float = np.nan

    def __post_init__(self) -> None:
        """Broadcast numbers for `body_force` and `energy` to all samples."""
        for name, shape in (("body_force", self.t.shape), ("energy", (*self.t.shape, 4))):
            full = np.broadcast_to(np.asarray(getattr(self, name), dtype=float), shape)
            object.__setattr__(self, name, full)

    @property
    def on_body(self) -> NDArray[np.bool_]:
        """Whether the body itself presses on the ground, shape (n,); False where not modelled."""
        return np.asarray(self.body_force) > 0

    @property
    def in_flight(self) -> NDArray[np.bool_]:
        """Whether neither a leg nor the body presses on the ground, shape (n,)."""
        return ~self.contact.any(axis=1) & ~self.on_body

    @property
    def poses(self) -> Poses:
        """Position x, y of the body's centre and yaw at every sample."""
        return Poses(self.t, self.position[:, :2], self.yaw)

    @property
    def yaw(self) -> Array:
        """Heading, unwrapped, shape (n,) [rad]."""
        return self.orientation[:, 2]

    def part(self, keep: slice | NDArray[np.bool_] | NDArray[np.intp]) -> Self:
        """Return the path at the samples that a slice, a mask or indices select."""
        return type(self)(**{f.name: getattr(self, f.name)[keep] for f in fields(self)})

    @property
    def length(self) -> float:
        """Length of the body centre's path seen from above, summed over the samples [m]."""
        return float(np.linalg.norm(np.diff(self.position[:, :2], axis=0), axis=1).sum())


def turning_radius(position_xy: Array, yaw: Array) -> float:
    r"""Compute the turning radius from first and last pose: the circle's that joins them.

    .. math::
        R = \frac{|\Delta p|}{2 |\sin(\Delta\psi / 2)|} \operatorname{sign} \Delta\psi

    Exact for a circular arc, and for whole strides of a constant gait, whose poses lie on one; not
    to be trusted where they come near a whole turn, which brings the last pose back to the first.

    Args:
        position_xy: Positions, shape (n, 2) [m].
        yaw: Unwrapped heading, shape (n,) [rad].

    Returns:
        Radius, positive for a left turn, infinite where first and last yaw are equal [m].
    """
    chord = float(np.linalg.norm(position_xy[-1] - position_xy[0]))
    turn = float(yaw[-1] - yaw[0])
    return np.inf if turn == 0 else float(np.copysign(chord / (2 * abs(np.sin(0.5 * turn))), turn))


def path_of(t: Array, pose: Array, theta: Array, legs: Array) -> WalkPath:
    """Convert poses (n + 1, 7) and the rows of legs and body of `run_steps`, (n, 7, 6), to a path.

    The first sample takes the rows of the first step's end, each other one those of its step.
    """
    orientation = roll_pitch_yaw(pose[:, 3:])
    energy = np.concatenate([np.zeros((1, 4)), np.cumsum(legs[:, N_LEGS, 1:5], axis=0)])
    legs = np.concatenate([legs[:1], legs])
    body, legs = legs[:, N_LEGS, 0], legs[:, :N_LEGS]
    load: Array = legs[..., 0]
    return WalkPath(
        t=t,
        position=pose[:, :3],
        orientation=orientation,
        theta=theta,
        contact=load > 0,
        slip_velocity=_to_heading(legs[..., 3:5], orientation[:, 2]),
        slip_ratio=legs[..., 5],
        normal_force=load,
        traction_force=_to_heading(legs[..., 1:3], orientation[:, 2]),
        body_force=body,
        energy=energy,
    )


def _to_heading(vectors: Array, yaw: Array) -> Array:
    """Rotate world vectors (x, y), shape (n, 6, 2), by -yaw to components forward and left."""
    c, s = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x + s * y, c * y - s * x], axis=-1)
