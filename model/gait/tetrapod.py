# SPDX-License-Identifier: MIT
"""The tetrapod: four legs on the ground, two in flight."""

import numpy as np

from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.notation import TETRAPOD


def tetrapod_reference(
    touchdown: float,
    liftoff: float,
    *,
    cycle_time: float,
    middle_start: float | None = np.pi / 2,
) -> CyclicReference:
    r"""Compute the leg angles of the tetrapod {1,4} ≺ {2,5} ≺ {3,6}, Eq. (5-5) to (5-12).

    .. math::
        \theta_{1,4}(0) = \theta_{LO}, \quad \theta_{2,5}(0) = \pi/2, \quad
        \theta_{3,6}(0) = \theta_{TD}, \qquad \tau_g = 2\tau_c/3, \quad \tau_f = \tau_c/3

    Legs 1 and 4 fly first, then 2 and 5, then 3 and 6. Each pair touches down as the next lifts off
    if pi/2 lies halfway between touchdown and lift-off, as it does in the thesis's simulation, pi/4
    and 3 pi/4. The angles set on its robot, 38 and 117 degrees, do not: there legs 2 and 5 would
    run ahead of the rhythm by a tenth of a cycle and fly while 1 and 4 still do. `middle_start`
    None puts legs 2 and 5 back into the rhythm.

    Args:
        touchdown: Touchdown angle [rad].
        liftoff: Lift-off angle [rad].
        cycle_time: tau_c [s].
        middle_start: Angle of legs 2 and 5 at time zero, from touchdown to lift-off, Eq. (5-6), or
            None for the one that keeps the rhythm: halfway between the two [rad].

    Returns:
        Leg angles.

    Raises:
        DomainError: Lift-off does not exceed touchdown by less than a turn, `middle_start` is not
            from touchdown to lift-off, or the cycle time is not positive and finite.
    """
    ground_time, flight_time = 2 * cycle_time / 3, cycle_time / 3
    share = 0.5
    if middle_start is not None:
        if not touchdown <= middle_start <= liftoff:
            raise DomainError(
                f"legs 2 and 5 start at {np.degrees(middle_start):g} degrees, Eq. (5-6); expected "
                f"from touchdown, {np.degrees(touchdown):g}, to lift-off, {np.degrees(liftoff):g} "
                "degrees: change one of the three, or pass middle_start=None for halfway"
            )
        share = (middle_start - touchdown) / (liftoff - touchdown)
    past_touchdown = np.array([1.0, share, 0.0]) * 2 / 3
    return CyclicReference(
        touchdown=np.array(touchdown),
        liftoff=np.array(liftoff),
        ground_time=np.array(ground_time),
        flight_time=np.array(flight_time),
        phase=past_touchdown[TETRAPOD.group_of],
    )
