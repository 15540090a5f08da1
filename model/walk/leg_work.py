# SPDX-License-Identifier: MIT
r"""Work of the legs' motors, and what slip and contacts take of it.

Legs are massless, so a motor's torque at the hip balances the force F that the ground exerts on
its leg. A foot moves with velocity u relative to the body as the leg turns; the motor's power is

.. math::
    P = \tau \dot\theta = -F \cdot u, \qquad
    u = \dot\theta\, e_y \times (p_{foot} - p_{hip}),

with the body's axis e_y. It is positive where the motor drives the leg, negative where the robot
drives the motor. With normal force N, gap rate, traction T and slip velocity v of every contact,
and the body's kinetic and potential energy E,

.. math::
    \sum_{legs} P = \dot E + \sum_{contacts} (-T \cdot v) + \sum_{contacts} (-N \dot g) .

The last two are what slip takes, and what contacts take along the normal: their dampers dissipate
it, but for the energy of their springs, which is less than a millijoule where a robot stands.
"""

from dataclasses import dataclass

import numpy as np

from model.compiled import inlined
from model.walk.anisotropy import sideways
from model.walk.contact_points import point_velocity
from model.walk.path import WalkPath


@dataclass(frozen=True)
class LegWork:
    """Energies of a walk, all zero or more but for what rounding and springs leave.

    Attributes:
        done: Work that motors do on legs, summed over legs and times in which they drive [J].
        taken_back: Work that legs do on motors, over all other times [J].
        slip: Energy that slip takes [J].
        contacts: Energy that contacts take along their normals [J].
    """

    done: float
    taken_back: float
    slip: float
    contacts: float


def leg_work(path: WalkPath) -> LegWork:
    """Compute the work of the legs' motors in a walk, and what slip and contacts take.

    Args:
        path: A walk, or a part of one; NaN results if its model computes no work.
    """
    energy = np.asarray(path.energy)
    done, taken_back, slip, contacts = (energy[-1] - energy[0]).tolist()
    return LegWork(done, taken_back, slip, contacts)


@inlined
def add_work(state, work, dt, out):
    """Add the energies of a step that has been taken to those before.

    Forces and velocities are those of the step's end, as in the step itself, which is implicit:
    the sum of all energies is balanced to first order in the step.

    Args:
        state: State at the step's end.
        work: Contacts of the step, with their loads.
        dt: Length of the step [s].
        out: Work done and taken back, energy to slip and to contacts, shape (4,), added to [J].
    """
    point = work.point
    for i in range(len(work.load)):
        if work.load[i] == 0.0:
            continue
        m, u = work.normal[i], work.velocity[i]
        point_velocity(state.v, state.w, work.place[i], u, point)
        rise = point[0] * m[0] + point[1] * m[1] + point[2] * m[2]
        for a in range(3):
            point[a] -= rise * m[a]
        lateral, across = work.lateral[i], work.across[i]
        more = work.secant[i] * sideways(lateral, across, point)
        power, slip = 0.0, 0.0
        for a in range(3):
            along = point[a]
            traction = -work.secant[i] * along - more * across[a]
            power -= (work.load[i] * m[a] + traction) * u[a]
            slip -= traction * along
        out[0] += max(power, 0.0) * dt
        out[1] += max(-power, 0.0) * dt
        out[2] += slip * dt
        out[3] -= work.load[i] * rise * dt
