# SPDX-License-Identifier: MIT
"""Draws of how legs and floor differ from the description of the robot and its slip law."""

import math
from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.robot import N_LEGS, Robot
from model.walk.bend import Bend
from model.walk.traction import TractionTable

ARCS = (np.pi / 2, np.radians(359.0))  # least and largest angle of a leg's arc [rad]
ANISOTROPY: Final = 1.3
"""Factor by which lateral grip and stiffness differ from longitudinal ones if unmeasured [-]."""


def log_spread(anisotropy: float) -> float:
    """Return the standard deviation of the logarithm of a factor that is 1 ×/÷ `anisotropy`.

    Args:
        anisotropy: The factor, one standard deviation; 1 for none [-].

    Raises:
        DomainError: It is below 1 or not finite.

    >>> round(log_spread(1.3), 3)
    0.262
    """
    if not (anisotropy >= 1 and math.isfinite(anisotropy)):
        raise DomainError(f"the anisotropy is {anisotropy:g}; expected a finite factor, 1 or more")
    return math.log(anisotropy)


@dataclass(frozen=True)
class LegState:
    """Corrections to the description of robot and slip law: m draws from a prior or a posterior.

    Attributes:
        offset: Angles added to `Robot.leg_offset`, shape (m, 6) [rad].
        grip: Factor on traction, shape (m,) [-].
        stiffness: Factor on slip stiffness, shape (m,) [-].
        fall: Factor on the post-peak drop; 0 removes the drop, shape (m,) [-].
        lateral_grip: Grip across the legs' rolling direction over that along it, shape (m,) [-].
        lateral_stiffness: Slip stiffness across it over that along it, shape (m,) [-].
        arc: Angle added to `Robot.leg_arc`, shape (m,) [rad].
        steering: Constant curvature added to the path, positive to the left, shape (m,) [rad/m].
        stride: Relative error of distance: the path is 1 + stride times as long, shape (m,) [-].
    """

    offset: Array
    grip: Array
    stiffness: Array
    fall: Array
    lateral_grip: Array
    lateral_stiffness: Array
    arc: Array
    steering: Array
    stride: Array

    def __len__(self) -> int:
        """Return the number of draws."""
        return len(self.grip)

    def part(self, chosen: slice) -> "LegState":
        """Return some of the draws.

        Args:
            chosen: Which draws.
        """
        return LegState(**{each.name: getattr(self, each.name)[chosen] for each in fields(self)})

    @staticmethod
    def of_prior(
        n: int, *, offset_sd: float, anisotropy: float = 1.0, rng: np.random.Generator
    ) -> "LegState":
        """Draw leg offsets and lateral traction from a prior; leave all else as described.

        An encoder's zero known to one count is uniform over it: standard deviation count/sqrt(12).

        Args:
            n: Number of draws.
            offset_sd: Standard deviation of an offset, which is uniform about zero [rad].
            anisotropy: Factor by which lateral grip and lateral stiffness differ from 1: each is
                log-normal with this factor as standard deviation; 1 for no difference [-].
            rng: Source of randomness. Factors come from a generator of their own, so that all
                other draws are the same with any `anisotropy`.

        Raises:
            DomainError: `anisotropy` is below 1 or not finite.
        """
        spread = log_spread(anisotropy)
        reach = np.sqrt(3.0) * offset_sd
        offset = rng.uniform(-reach, reach, (n, N_LEGS))
        one, no = np.ones(n), np.zeros(n)
        grip, stiffness = np.exp(spread * rng.spawn(1)[0].standard_normal((2, n)))
        return LegState(offset, one, one, one, grip, stiffness, no, no, no)


def robot_in(robot: Robot, state: LegState, i: int) -> Robot:
    """Return a copy of the robot with the leg offsets and the leg arc of one draw added.

    The arc is held to 90 to 359 degrees.

    Args:
        robot: The robot as described.
        state: Draws of the legs' state.
        i: Index of the draw.
    """
    return replace(
        robot,
        leg_offset=robot.leg_offset + state.offset[i],
        leg_arc=float(np.clip(robot.leg_arc + state.arc[i], *ARCS)),
    )


def law_in(table: TractionTable, state: LegState, i: int) -> TractionTable:
    """Return a slip law's table scaled by the factors of one draw, lateral traction included.

    Args:
        table: The slip law as calibrated.
        state: Draws of the legs' state.
        i: Index of the draw.
    """
    scaled = scaled_table(
        table,
        grip=float(state.grip[i]),
        stiffness=float(state.stiffness[i]),
        fall=float(state.fall[i]),
    )
    return scaled._replace(
        lateral_grip=float(state.lateral_grip[i]),
        lateral_stiffness=float(state.lateral_stiffness[i]),
    )


def corrected(
    robot: Robot, table: TractionTable, state: LegState
) -> tuple[Robot, TractionTable, Bend]:
    """Correct a robot and its slip law by the first draw, and return how its path is bent.

    Args:
        robot: The robot as described.
        table: The slip law as calibrated.
        state: Draws of the legs' state, such as the most probable one.
    """
    bend = Bend(float(state.stride[0]), float(state.steering[0]))
    return robot_in(robot, state, 0), law_in(table, state, 0), bend


def scaled_table(
    table: TractionTable, *, grip: float, stiffness: float, fall: float = 1.0
) -> TractionTable:
    """Scale a table's traction and, independently, its slip stiffness and its post-peak drop.

    A rig measures the post-peak drop under legs that slide for seconds. A walking leg lifts off
    earlier, and its slip is a velocity as much as a ratio. The post-peak drop is therefore the part
    of a law that applies least to a walk.

    Args:
        table: The law.
        grip: Factor on traction, peak and toe included [-].
        stiffness: Factor on slip stiffness; slips, and the slip velocity over which traction on a
            toe sets in, are scaled by grip over stiffness [-].
        fall: Factor on how far traction falls beyond its peak; 0 keeps it at the peak [-].
    """
    if grip == stiffness == fall == 1.0:  # draws that no walk informs share the tables
        return table
    table = _with_fall(table, fall)
    shrink = stiffness / grip
    return table._replace(
        phi=table.phi * grip,
        slope=table.slope * grip,
        toe=table.toe * grip,
        scale=table.scale if table.by_velocity else table.scale / shrink,
        speed_scale=table.speed_scale / shrink,
    )


def _with_fall(table: TractionTable, fall: float) -> TractionTable:
    """Multiply each row's drop below its peak, at slips beyond the peak and on a toe, by `fall`."""
    top = table.phi.max(axis=1)
    beyond = np.arange(table.phi.shape[1]) >= table.phi.argmax(axis=1)[:, None]
    phi = np.where(beyond, top[:, None] - fall * (top[:, None] - table.phi), table.phi)
    slope = np.where(beyond, fall * table.slope, table.slope)
    return table._replace(phi=phi, slope=slope, toe=top - fall * (top - table.toe))
