# SPDX-License-Identifier: MIT
"""Traction of contacts from tabulated slip laws, one law for each walk, compiled.

The tables are those of `model.walk.traction`, and so are the results but for rounding.
"""

from model.compiled import inlined
from model.elementary import arsinh, log_of
from model.lanes import any_of, floor, gathered, negated, root, row, select
from model.walk.flat.rows import (
    BY_VELOCITY,
    FIRST_LOAD,
    PER_LOAD_STEP,
    PER_SCALE,
    PER_STEP,
    SPEED_SCALE,
)

LEAST_SLIP = 1e-9  # the secant's limit at no slip is the law's slope


@inlined
def secant(A, laws, rolls, pressed, load, slip, turn, radius):
    """Compute traction over slip velocity of one contact of each walk [N s/m].

    Args:
        A: The walks' rows.
        laws: The laws' tables as in `Laws`.
        rolls: Whether the contact is that of a leg that rolls.
        pressed: Whether it has load; elsewhere the result is without meaning.
        load: Normal force [N].
        slip: Speed of the material contact point over the ground [m/s].
        turn: Speed at which the leg turns over the ground, of either sign [rad/s].
        radius: Radius of the leg's arc [m].
    """
    level = (log_of(select(pressed, load, 1.0)) - row(A, FIRST_LOAD)) * row(A, PER_LOAD_STEP)
    level = select(level > 0.0, level, 0.0)
    below = floor(level)
    last = laws.loads - 2.0
    below = select(below < last, below, last)
    share = level - below
    share = select(share < 1.0, share, 1.0)
    v0 = row(A, SPEED_SCALE)
    rolls = rolls & (row(A, BY_VELOCITY) == 0.0)
    G = load * 0.0
    if any_of(pressed & negated(rolls)):
        toe, above = gathered(laws.toe, below, 2)
        G = load * (toe + share * (above - toe)) / root(slip * slip + v0 * v0)
    if any_of(pressed & rolls):
        flow = turn * radius
        flow = root(flow * flow + v0 * v0)
        least = LEAST_SLIP * flow
        x = select(slip > least, slip / flow, LEAST_SLIP)
        value = _table_value(A, laws, below, share, x)
        rolling = load * value / select(slip > least, slip, least)
        G = select(rolls, rolling, G)
    return G


@inlined
def _table_value(A, laws, below, share, x):
    """Interpolate traction over load at slip x, `share` of the way from row `below` to the next."""
    place = arsinh(x * row(A, PER_SCALE)) * row(A, PER_STEP)
    last = laws.slips - 1.000001
    place = select(place < last, place, last)
    column = floor(place)
    a = place - column
    cell = 2.0 * (below * laws.slips + column)
    p0, m0, p1, m1 = gathered(laws.phi, cell, 4)
    lower = _hermite(p0, p1, m0, m1, a)
    p0, m0, p1, m1 = gathered(laws.phi, cell + 2.0 * laws.slips, 4)
    return lower + share * (_hermite(p0, p1, m0, m1, a) - lower)


@inlined
def _hermite(p0, p1, m0, m1, a):
    """Interpolate between values p0 and p1 with slopes m0 and m1 a column, at a from 0 to 1."""
    d = p1 - p0
    return p0 + a * (m0 + a * (3.0 * d - 2.0 * m0 - m1 + a * (m0 + m1 - 2.0 * d)))
