# SPDX-License-Identifier: MIT
"""The steering-factor tripod: touchdown and lift-off angles that turn the robot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction, inner_legs, is_inner
from model.gait.notation import TRIPOD

_HALVINGS = 60  # of a bracket of pi: to the last bit of a leg angle


@dataclass(frozen=True)
class TripodAngles:
    """Touchdown and lift-off angles of the inner and outer legs of a tripod.

    Attributes:
        inner_touchdown: Touchdown angle of the inner legs [rad].
        inner_liftoff: Lift-off angle of the inner legs [rad].
        outer_touchdown: Touchdown angle of the outer legs [rad].
        outer_liftoff: Lift-off angle of the outer legs [rad].

    Raises:
        DomainError: A side's lift-off does not exceed its touchdown by less than a turn.
    """

    inner_touchdown: float
    inner_liftoff: float
    outer_touchdown: float
    outer_liftoff: float

    def __post_init__(self) -> None:
        """Check that each side's lift-off angle exceeds its touchdown angle by less than a turn."""
        for side, down, up in (
            ("inner", self.inner_touchdown, self.inner_liftoff),
            ("outer", self.outer_touchdown, self.outer_liftoff),
        ):
            if not 0 < up - down < 2 * np.pi:
                raise DomainError(
                    f"{side} legs touch down at {np.degrees(down):g} and lift off at "
                    f"{np.degrees(up):g} degrees; expected lift-off beyond touchdown, by less "
                    "than 360 degrees"
                )

    @property
    def steering_factor(self) -> float:
        """Stance angle of the outer legs over that of the inner legs, Eq. (2-18) [-]."""
        outer = self.outer_liftoff - self.outer_touchdown
        return outer / (self.inner_liftoff - self.inner_touchdown)


def ideal_liftoff(touchdown: ArrayLike, leg_arc: float = np.pi) -> Array:
    r"""Compute the lift-off angle at which the hip is as high as at touchdown, Eq. (2-17).

    .. math::
        \theta_{LO} = \pi - \arcsin\frac{\sin\theta_{TD} + 1}{2}

    is the thesis's, for a half circle, from equal heights in Eq. (2-16). A leg whose arc A is
    longer or shorter stands on its arc up to the angle A - pi/2 and on its toe beyond, with hip
    heights

    .. math::
        h = r (1 + \sin\theta), \qquad
        h = 2 r \sin\tfrac{A}{2}\, \sin\bigl(\theta - \tfrac{A - \pi}{2}\bigr) ,

    so that in general

    .. math::
        \theta_{LO} = \pi + \tfrac{A - \pi}{2} - \arcsin\frac{h_{TD}/r}{2\sin(A/2)} ,

    with h_TD the hip height at touchdown, or :math:`\pi - \theta_{TD}` where that is still on the
    arc: legs longer than a half circle that touch down late.

    Args:
        touchdown: Touchdown angles, before the one at which the hip is highest [rad].
        leg_arc: A, angle of the leg's arc [rad].

    Returns:
        Lift-off angles [rad].

    Raises:
        DomainError: A touchdown angle is not between -90 degrees and the highest hip's.

    >>> np.degrees(ideal_liftoff(np.radians(50.0))).round(4).item()
    117.9909
    >>> np.degrees(ideal_liftoff(np.radians(50.0), np.radians(200.0))).round(4).item()
    126.2796
    """
    theta = np.asarray(touchdown, dtype=float)
    highest = highest_hip(leg_arc)
    if not np.all((theta > -np.pi / 2) & (theta < highest)):
        raise DomainError(
            f"touchdown angle is {np.degrees(theta)} degrees; expected above -90 and below "
            f"{np.degrees(highest):g}, where the hip of a leg with an arc of "
            f"{np.degrees(leg_arc):g} degrees is highest: later it never is as high again"
        )
    return _ideal_liftoff(theta, leg_arc)


def highest_hip(leg_arc: float) -> float:
    """Return the leg angle at which the hip is highest [rad]."""
    # On the arc of a long leg, on the toe of a short one.
    return min(np.pi / 2, leg_arc / 2)


def _ideal_liftoff(theta: Array, leg_arc: float) -> Array:
    """Compute `ideal_liftoff` without a check of the touchdown angles theta."""
    last_on_arc, chord = leg_arc - np.pi / 2, 2 * np.sin(leg_arc / 2)
    lean = (leg_arc - np.pi) / 2
    height = np.where(theta <= last_on_arc, 1 + np.sin(theta), chord * np.sin(theta - lean))
    on_toe = np.pi + lean - np.arcsin(np.minimum(height / chord, 1.0))
    return np.where(np.pi - theta <= last_on_arc, np.pi - theta, on_toe)


def largest_steering_factor(inner_touchdown: float, leg_arc: float = np.pi) -> float:
    r"""Compute the steering factor below which Eq. (2-19) has a solution [-].

    The outer legs' stance angle grows as they touch down earlier, to :math:`\pi + A/2` as their
    touchdown tends to -90 degrees, where the hip is on the ground.

    Args:
        inner_touchdown: Touchdown angle of the inner legs [rad].
        leg_arc: A, angle of the leg's arc [rad].

    Raises:
        DomainError: The touchdown angle is not between -90 degrees and the highest hip's.

    >>> round(largest_steering_factor(np.radians(50.0)), 3)
    3.971
    """
    stance = float(ideal_liftoff(inner_touchdown, leg_arc)) - inner_touchdown
    return float(np.pi + leg_arc / 2) / float(stance)


def solve_outer_touchdown(
    inner_touchdown: float, steering_factor: float, *, leg_arc: float = np.pi
) -> float:
    r"""Compute the touchdown angle of the outer legs, the root of Eq. (2-19).

    .. math::
        \theta_{LO}(\theta_{TD}^o) - \theta_{TD}^o = s\,(\theta_{LO}^i - \theta_{TD}^i)

    with the ideal lift-off angle of `ideal_liftoff` on both sides. The left side falls strictly in
    its argument, from the limit in `largest_steering_factor` to zero where the hip is highest, so
    there is one root [rad], found by bisection.

    Args:
        inner_touchdown: Touchdown angle of the inner legs [rad].
        steering_factor: s, outer over inner stance angle, Eq. (2-18); 1 goes straight [-].
        leg_arc: A, angle of the leg's arc [rad].

    Raises:
        DomainError: The steering factor is not positive, or too large for the inner touchdown
            angle; or that angle has no ideal lift-off.
    """
    if not steering_factor > 0:
        raise DomainError(
            f"steering factor is {steering_factor:g}; expected more than zero: 1 goes straight, "
            "choose the side with direction"
        )
    largest = largest_steering_factor(inner_touchdown, leg_arc)
    if steering_factor >= largest:
        raise DomainError(
            f"steering factor {steering_factor:g} has no solution with inner touchdown at "
            f"{np.degrees(inner_touchdown):g} degrees; expected less than {largest:.4g}: choose it "
            "smaller, or let the inner legs touch down later"
        )
    inner_stance = float(ideal_liftoff(inner_touchdown, leg_arc)) - inner_touchdown
    return touchdown_of_stance(steering_factor * inner_stance, leg_arc=leg_arc)


def touchdown_of_stance(stance: float, *, leg_arc: float = np.pi) -> float:
    r"""Compute the touchdown angle of a stance that ends with the hip as high as it began [rad].

    It is the root of :math:`\theta_{LO}(\theta_{TD}) - \theta_{TD} = \Delta\theta` with the ideal
    lift-off angle of `ideal_liftoff`, found by bisection; at a stance of zero the angle of the
    highest hip.

    Args:
        stance: Stance angle, from 0 to below pi + A/2 [rad].
        leg_arc: A, angle of the leg's arc [rad].

    >>> angle = touchdown_of_stance(np.radians(117.9909 - 50.0))
    >>> round(float(np.degrees(angle)), 3)
    50.0
    """
    low, high = -np.pi / 2, highest_hip(leg_arc)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        found = float(_ideal_liftoff(np.array(middle), leg_arc)) - middle
        low, high = (middle, high) if found > stance else (low, middle)
    return (low + high) / 2


def scaled_stance(
    touchdown: float, liftoff: float, share: float, leg_arc: float
) -> tuple[float, float]:
    """Return touchdown and lift-off angles of a shorter stance, a share of the given one [rad].

    They are those of equal hip height, both turned by the share of how far the given stance is
    turned from equal hip height: at 1 the given ones, at 0 both the angle of the highest hip.

    Args:
        touchdown: Touchdown angle of the whole stance [rad].
        liftoff: Its lift-off angle [rad].
        share: Share of the stance angle, from 0 to 1 [-].
        leg_arc: Angle of the legs' arc [rad].
    """
    if share == 1:
        return touchdown, liftoff
    stance = liftoff - touchdown
    later = touchdown - touchdown_of_stance(stance, leg_arc=leg_arc)
    down = touchdown_of_stance(share * stance, leg_arc=leg_arc) + share * later
    return down, down + share * stance


def tripod_angles(
    inner_touchdown: float,
    steering_factor: float = 1.0,
    *,
    leg_arc: float = np.pi,
    inner_liftoff: float | None = None,
    outer_touchdown: float | None = None,
    outer_liftoff: float | None = None,
) -> TripodAngles:
    """Compute touchdown and lift-off angles of a turning tripod from a steering factor, 2-6-2.

    Given angles are kept, missing ones (None) computed. A missing outer touchdown follows from the
    ideal lift-off angles even where other lift-offs are given, as on the thesis's robot (Tables 5-3
    to 5-5). A missing outer lift-off is the ideal one, or, where the inner lift-off is given, that
    which keeps the steering factor, Eq. (2-18).

    Args:
        inner_touchdown: Touchdown angle of the inner legs [rad].
        steering_factor: s, outer over inner stance angle; without effect where no missing angle
            depends on it, as with a given outer touchdown and no given lift-off [-].
        leg_arc: Angle of the leg's arc [rad].
        inner_liftoff: Lift-off angle of the inner legs; Eq. (2-17) when None [rad].
        outer_touchdown: Touchdown angle of the outer legs; Eq. (2-19) when None [rad].
        outer_liftoff: Lift-off angle of the outer legs; as above when None [rad].

    Raises:
        DomainError: A touchdown angle has no ideal lift-off, the steering factor has no solution,
            or a lift-off does not exceed touchdown by less than a turn.

    >>> angles = tripod_angles(np.radians(50.0), 1.1)
    >>> np.degrees([angles.outer_touchdown, angles.outer_liftoff]).round(4).tolist()
    [45.9586, 120.7486]
    """
    inner_up = inner_liftoff
    if inner_up is None:
        inner_up = float(ideal_liftoff(inner_touchdown, leg_arc))
    outer_down = outer_touchdown
    if outer_down is None:
        outer_down = solve_outer_touchdown(inner_touchdown, steering_factor, leg_arc=leg_arc)
    if outer_liftoff is not None:
        outer_up = outer_liftoff
    elif inner_liftoff is not None:
        outer_up = outer_down + steering_factor * (inner_liftoff - inner_touchdown)
    else:
        outer_up = float(ideal_liftoff(outer_down, leg_arc))
    return TripodAngles(inner_touchdown, inner_up, outer_down, outer_up)


def tripod_reference(
    angles: TripodAngles, cycle_time: float, *, direction: Direction = "left"
) -> CyclicReference:
    """Compute the leg angles of the steering-factor tripod, Eq. (2-20) to (2-22).

    Legs are half the cycle on the ground, half in flight. At time zero legs 1, 4 and 5 touch down
    and legs 2, 3 and 6 lift off, whichever way the robot turns (Listing A.4); so a right turn is
    the mirror image of a left turn half a cycle later.

    Args:
        angles: Touchdown and lift-off angles of both sides.
        cycle_time: tau_c [s].
        direction: Side to which the robot turns; the result's `inner`, also at steering factor 1.

    Returns:
        Leg angles.

    Raises:
        DomainError: The cycle time is not positive and finite, or the direction unknown.
    """
    inner = is_inner(direction)
    return CyclicReference(
        touchdown=np.where(inner, angles.inner_touchdown, angles.outer_touchdown),
        liftoff=np.where(inner, angles.inner_liftoff, angles.outer_liftoff),
        ground_time=np.array(cycle_time / 2),
        flight_time=np.array(cycle_time / 2),
        phase=np.where(TRIPOD.group_of == 0, 0.0, 0.5),
        inner=inner_legs(direction),
    )
