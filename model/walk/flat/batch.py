# SPDX-License-Identifier: MIT
"""Arrays of walks on flat ground for the compiled loop, from robots, laws and states."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeGuard

import numpy as np

from model.arrays import Array
from model.lanes import LANES
from model.robot import N_LEGS, Robot
from model.walk.areas import AreaTractions
from model.walk.arrays import N_CONTACTS, Contacts, State, body_arrays
from model.walk.flat import rows
from model.walk.flat.loop import run_flat
from model.walk.ground import Ground, is_level
from model.walk.traction import TractionTable


class Laws(NamedTuple):
    """Tables of the slip laws of several walks, all with the same loads and columns.

    Attributes:
        phi: Of each walk, by load and then by slip: traction over load, and its derivative by a
            column, shape (walks, 2 loads slips) [-].
        toe: Largest traction over load of a leg on its toe, shape (walks, loads) [-].
        loads: Number of loads, at least two.
        slips: Number of slips.
        directed: True where a law differs along and across the legs' rolling direction, else None,
            of which numba compiles a loop of its own, without what directions need.
    """

    phi: Array
    toe: Array
    loads: float
    slips: float
    directed: bool | None


@dataclass(frozen=True)
class FlatWalk:
    """What one walk on flat ground is computed from.

    Attributes:
        robot: The robot; its leg offsets are in `theta` already.
        table: The slip law, without bristles.
        contacts: Stiffness and damping of contacts.
        state: Initial state, overwritten with the final one.
        theta: Leg angles at every step's start and the last one's end, shape (n + 1, 6) [rad].
    """

    robot: Robot
    table: TractionTable
    contacts: Contacts
    state: State
    theta: Array


def is_flat_walk(table: TractionTable | AreaTractions, ground: Ground) -> TypeGuard[TractionTable]:
    """Return whether walks of a law on a ground are computed here: level, one law, no bristles.

    Args:
        table: The slip law.
        ground: The ground.
    """
    return isinstance(table, TractionTable) and not table.bristle and is_level(ground)


def run_side_by_side(
    walks: Sequence[FlatWalk], dt: float, *, height: float = 0.0, keep_legs: bool = False
) -> tuple[Array, Array, list[int]]:
    """Integrate one walk, or up to `LANES` side by side, through leg angles at equal steps.

    Args:
        walks: The walks, with equally many steps.
        dt: Length of a step [s].
        height: Height of the ground [m].
        keep_legs: Whether to return slip and forces of the legs and the body.

    Returns:
        Position [m] and quaternion at the times of the leg angles, shape (walks, n + 1, 7); slip
        and forces at each step's end as in `model.walk.loop.run_steps`, shape (walks, n, 7, 6), or
        (walks, 0, 7, 6) if not kept; and for each walk the number of steps computed: n, or fewer
        where the state stopped being finite.
    """
    single = len(walks) == 1
    filled = list(walks) if single else [*walks, *[walks[-1]] * (LANES - len(walks))]
    each = np.zeros((rows.N_ROWS, len(filled)))
    for column, walk in zip(each.T, filled, strict=True):
        _fill(column, walk, height)
    theta = np.stack([walk.theta for walk in filled])
    n = theta.shape[1] - 1
    pose = np.empty((len(filled), n + 1, 7))
    pose[:, 0] = each[rows.P : rows.P + 7].T
    legs = np.empty((len(filled), n if keep_legs else 0, N_LEGS + 1, 6))
    done = np.zeros(len(filled), dtype=np.int64)
    laws = _laws([walk.table for walk in filled])
    A = each.ravel() if single else each
    run_flat(A, each, laws, theta, dt, pose[:, 1:], legs, done, done.copy())
    for column, walk in zip(each.T, walks, strict=False):
        state = column[rows.STATE : rows.STATE + rows.N_STATE]
        for to, values in zip(walk.state[:4], np.split(state, [3, 7, 10]), strict=True):
            to[:] = values
    return pose[: len(walks)], legs[: len(walks)], done[: len(walks)].tolist()


def _fill(column: Array, walk: FlatWalk, height: float) -> None:
    """Fill a walk's column with what is given once, and its state."""
    body, table = body_arrays(walk.robot), walk.table
    several = len(table.log_load) > 1
    per_load_step = 1 / float(table.log_load[1] - table.log_load[0]) if several else 0.0
    given = [
        body.hips.ravel(), [body.leg_radius, body.toe_cos, body.toe_sin, body.mass], body.inertia,
        body.half_size, [walk.contacts.stiffness, walk.contacts.damping, height],
        [float(table.by_velocity), 1 / table.scale, 1 / table.step, table.speed_scale],
        [table.log_load[0], per_load_step],
        *(
            [each] * N_LEGS + [1.0] * (N_CONTACTS - N_LEGS)
            for each in (table.lateral_stiffness, table.lateral_stiffness / table.lateral_grip)
        ),
    ]  # fmt: skip
    column[: rows.GIVEN] = np.concatenate(given)
    column[rows.HEADING_COS] = 1.0
    state = np.concatenate(walk.state[:4])
    column[rows.STATE : rows.STATE + rows.N_STATE] = state


def _laws(tables: Sequence[TractionTable]) -> Laws:
    """Stack tables; one that has a single row is given as many as the largest, at least two."""
    loads = max(2, *(len(table.log_load) for table in tables))
    slips = tables[0].phi.shape[1]
    phi, toe = np.empty((len(tables), loads, slips, 2)), np.empty((len(tables), loads))
    for i, table in enumerate(tables):
        phi[i, ..., 0], phi[i, ..., 1] = table.phi, table.slope * table.step
        toe[i] = table.toe
    directed = True if any(table.is_directed for table in tables) else None
    return Laws(phi.reshape(len(tables), -1), toe, float(loads), float(slips), directed)
