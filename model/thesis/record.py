# SPDX-License-Identifier: MIT
"""Samples of the thesis's walk that are kept."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled
from model.robot import N_LEGS


class Record(NamedTuple):
    """Arrays of the n samples that are kept: the state before a step, and the step's quantities.

    Attributes:
        state: x, y, z [m], roll, pitch and yaw of Eq. (3-7) [rad], shape (n, 6).
        rates: Rates of the state, after what a change of contacts sets, (n, 6) [m/s, rad/s].
        acceleration: Their change by the step's forces, over the step, (n, 6) [m/s2, rad/s2].
        contact: Whether a leg carries load, shape (n, 6).
        kappa: Longitudinal slip of a leg that carries load, as `find_slip` computes it, else NaN,
            shape (n, 6) [-].
        normal: Normal force, zero without contact, shape (n, 6) [N].
        forward: Traction force forward, zero without contact, shape (n, 6) [N].
        left: Traction force to the left, zero without contact, shape (n, 6) [N].
        static: Normal force in static equilibrium, zero without contact, shape (n, 6) [N].
        phi: Angle of the lowest point of each leg's circle, shape (n, 6) [rad].
        phi_rate: Rate of phi, shape (n, 6) [rad/s].
        height: Height of each hip above its leg's lowest point, in the leg's plane, (n, 6) [m].
        speeds: `Balance.speeds` of a leg that carries load, else NaN, shape (n, 6, 3) [m/s].
    """

    state: Array
    rates: Array
    acceleration: Array
    contact: NDArray[np.bool_]
    kappa: Array
    normal: Array
    forward: Array
    left: Array
    static: Array
    phi: Array
    phi_rate: Array
    height: Array
    speeds: Array


def empty_record(rows: int) -> Record:
    """Allocate a record of as many samples as rows, all legs without contact."""
    shape = (rows, N_LEGS)
    return Record(
        np.empty((rows, 6)), np.empty((rows, 6)), np.empty((rows, 6)),
        np.zeros(shape, dtype=bool), np.full(shape, np.nan), np.zeros(shape), np.zeros(shape),
        np.zeros(shape), np.zeros(shape), np.empty(shape), np.empty(shape), np.empty(shape),
        np.full((*shape, 3), np.nan),
    )  # fmt: skip


@compiled
def keep_legs(record, row, legs):
    """Keep the kinematics of all legs in a row of the record.

    Args:
        record: The record.
        row: Index of the sample.
        legs: Kinematics of the legs.
    """
    record.phi[row] = legs.phi
    record.phi_rate[row] = legs.phi_rate
    record.height[row] = legs.height


@compiled
def keep_contacts(record, row, three, balance, static, loads, forces):
    """Keep contacts, slip, speeds and forces of the legs that carry load in a row of the record.

    Args:
        record: The record.
        row: Index of the sample.
        three: Indices of the legs that carry load, shape (3,).
        balance: Their contacts.
        static: Their normal forces in static equilibrium, shape (3,) [N].
        loads: Their normal forces, shape (3,) [N].
        forces: Their forces forward and to the left, shape (3, 2) [N].
    """
    for k in range(3):
        i = three[k]
        record.contact[row, i] = True
        record.kappa[row, i] = balance.slip[k, 0]
        record.normal[row, i] = loads[k]
        record.static[row, i] = static[k]
        record.forward[row, i], record.left[row, i] = forces[k, 0], forces[k, 1]
        record.speeds[row, i] = balance.speeds[k]
