# SPDX-License-Identifier: MIT
"""Rows of the array in which walks on flat ground are computed: one column for each walk.

A row is one number of every walk; vectors and lists take as many rows as they have numbers, those
of contacts in the order six legs, then eight corners of the body. Units are SI.
"""

from model.robot import N_LEGS
from model.walk.arrays import N_CONTACTS

_next = 0


def _rows(n: int) -> int:
    """Reserve n rows; return the first."""
    global _next
    first, _next = _next, _next + n
    return first


# Given once, by walk
HIPS = _rows(3 * N_LEGS)  # x, y, z in the body frame of one leg after the other
RADIUS = _rows(1)
TOE_COS, TOE_SIN = _rows(1), _rows(1)  # of the arc's angle beyond a half circle
MASS, INERTIA, HALF_SIZE = _rows(1), _rows(3), _rows(3)
STIFFNESS, DAMPING = _rows(1), _rows(1)
HEIGHT = _rows(1)  # of the ground
BY_VELOCITY = _rows(1)  # 1 where the law is one of slip velocity, else 0
PER_SCALE, PER_STEP = _rows(1), _rows(1)  # 1 over `scale` and `step` of the law's table
SPEED_SCALE = _rows(1)  # of the law's table
FIRST_LOAD, PER_LOAD_STEP = _rows(1), _rows(1)  # its first log load, and 1 over their step
# Across the legs' rolling direction, 1 for corners: secant over that along it, factor on slip
LATERAL_SECANT, LATERAL_SLIP = _rows(N_CONTACTS), _rows(N_CONTACTS)
GIVEN = _next
# State: position, quaternion, velocity, angular velocity; in world axes
P, Q, V, OMEGA = _rows(3), _rows(4), _rows(3), _rows(3)
STATE, N_STATE = P, 13
# Directly after the state, saved with it: loads, and accelerations of the step before
LOAD, GAIN = _rows(N_CONTACTS), _rows(6)
N_SAVED = N_STATE + N_CONTACTS + 6
BEFORE = _rows(N_SAVED)  # at a step's start
# Of a step
DT = _rows(1)
DAMPING_LEFT = _rows(1)  # beyond that of the step itself
ANGLE, SPEED = _rows(N_LEGS), _rows(N_LEGS)  # of the legs, angle at the step's end
HEADING_COS, HEADING_SIN = _rows(1), _rows(1)  # of the axes of a step
PLACE, VELOCITY = _rows(3 * N_CONTACTS), _rows(3 * N_CONTACTS)  # in the axes of the step
GAP, SECANT = _rows(N_CONTACTS), _rows(N_CONTACTS)
ROLLS = _rows(N_CONTACTS)  # 1 where a leg rolls, else 0
R = _rows(9)  # rotation of the body to the axes of the step, row by row
# Of the loop
FROM, TO = _rows(N_LEGS), _rows(N_LEGS)  # leg angles at the long step's start and end
LONG_STEP, PART, PARTS = _rows(1), _rows(1), _rows(1)
FRESH = _rows(1)  # 1 where a long step is begun, else 0
CHANGED = _rows(1)  # 1 where a contact has load in only one of `BEFORE` and now, else 0
N_ROWS = _next
