# SPDX-License-Identifier: MIT
"""Traction of a contact from a tabulated slip law, interpolated in slip and load, compiled."""

import numpy as np

from model.compiled import inlined
from model.leg import ROLLING


@inlined
def table_value(table, load, x):
    """Interpolate traction over load in a table; outside it the nearest load or slip is used.

    Args:
        table: The table.
        load: Normal force, positive [N].
        x: Slip ratio, or slip velocity over `speed_scale`; not negative [-].

    Returns:
        Traction over load [-].
    """
    w = np.arcsinh(x / table.scale)
    place = min(w / table.step, table.phi.shape[1] - 1.000001)
    j = int(place)
    a = place - j
    row, b = load_row(table, load)
    value = hermite(table.phi[row], table.slope[row], j, a, table.step)
    if b > 0:
        above = hermite(table.phi[row + 1], table.slope[row + 1], j, a, table.step)
        value += b * (above - value)
    return value


@inlined
def load_row(table, load):
    """Find the table's row below a load, and the interpolation weight in the load's logarithm.

    Args:
        table: The table.
        load: Normal force, positive [N].

    Returns:
        Index of the row, and weight of the next row, from 0 to 1 [-]; 0 and 0 for a single row.
    """
    m = len(table.log_load)
    if m == 1:
        return 0, 0.0
    first = table.log_load[0]
    place = max((np.log(load) - first) / (table.log_load[1] - first), 0.0)
    row = min(int(place), m - 2)
    return row, min(place - row, 1.0)


@inlined
def hermite(phi, slope, j, a, step):
    """Interpolate between columns j and j + 1 of a table's row by a cubic Hermite polynomial.

    Args:
        phi: Values of the columns, shape (n,).
        slope: Derivatives of the values with respect to w, shape (n,).
        j: Index of the column to the left.
        a: Position between the two columns, from 0 to 1 [-].
        step: Distance of neighbouring columns in w.
    """
    p0, p1, m0, m1 = phi[j], phi[j + 1], slope[j] * step, slope[j + 1] * step
    d = p1 - p0
    return p0 + a * (m0 + a * (3 * d - 2 * m0 - m1 + a * (m0 + m1 - 2 * d)))


@inlined
def traction_secant(table, state, load, slip_speed, flow_speed):
    """Compute traction over slip velocity of one contact [N s/m].

    A leg that rolls follows the table at slip ratio v over sqrt(u^2 + v_0^2), with slip speed v,
    flow speed u and v_0 = `speed_scale`. Any other contact, and every one if the law is
    `by_velocity`, has load times `toe_traction` over sqrt(v^2 + v_0^2).

    Args:
        table: The tabulated law.
        state: ROLLING; or TOE or HIP, which have the traction of a toe.
        load: Normal force [N].
        slip_speed: Speed of the material contact point over the ground [m/s].
        flow_speed: Speed at which the leg's arc passes the contact, if it rolls [m/s].
    """
    v0 = table.speed_scale  # also keeps finite the slip ratio of a leg that does not turn
    if table.by_velocity or state != ROLLING:
        return load * toe_traction(table, load) / np.sqrt(slip_speed**2 + v0**2)
    flow = np.sqrt(flow_speed**2 + v0**2)
    x = max(slip_speed / flow, 1e-9)  # the secant's limit at no slip is the law's slope
    return load * table_value(table, load, x) / (x * flow)


@inlined
def toe_traction(table, load):
    """Interpolate the largest traction over load of a leg on its toe in a table [-].

    Args:
        table: The slip law.
        load: Normal force, positive [N].
    """
    row, b = load_row(table, load)
    value = table.toe[row]
    if b > 0:
        value += b * (table.toe[row + 1] - value)
    return value
