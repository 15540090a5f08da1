# SPDX-License-Identifier: MIT
"""Paths of arcs and straights from the origin, heading along x, to a place or a pose."""

from typing import NamedTuple

import numpy as np


class Arc(NamedTuple):
    """An arc of a circle, or a straight.

    Attributes:
        length: Length [m].
        turn: Change of heading, positive to the left, beyond half a turn too [rad].
    """

    length: float
    turn: float


def arc_to(x: float, y: float) -> Arc | None:
    """Return the arc from the origin that leads to a place; None for one straight behind.

    An arc turns by twice the bearing of the place.

    Args:
        x: Distance ahead [m].
        y: Distance to the left [m].

    >>> round(arc_to(1.0, 1.0).length, 4), round(arc_to(1.0, 1.0).turn, 4)
    (1.5708, 1.5708)
    """
    bearing = float(np.arctan2(y, x))
    if abs(bearing) > np.pi - 1e-6:
        return None
    return Arc(float(np.hypot(x, y)) / float(np.sinc(bearing / np.pi)), 2 * bearing)


def arc_and_straight_to(x: float, y: float, radius: float) -> tuple[Arc, Arc] | None:
    """Return an arc of a given radius and the straight, tangent to it, that leads on to a place.

    The arc turns to the side of the place, to the left for a place straight ahead or behind.

    Args:
        x: Distance ahead [m].
        y: Distance to the left [m].
        radius: Radius of the arc [m].

    Returns:
        The two; None for a place within the circle, which they do not lead to.
    """
    side = 1.0 if y >= 0 else -1.0
    to_x, to_y = x, side * y - radius  # from the circle's centre, mirrored to the left
    far = float(np.hypot(to_x, to_y))
    if far <= radius:
        return None
    straight = float(np.sqrt(far**2 - radius**2))
    turn = float((np.arctan2(to_y, to_x) + np.arctan2(radius, straight)) % (2 * np.pi))
    return Arc(radius * turn, side * turn), Arc(straight, 0.0)


def two_arcs_to(x: float, y: float, heading: float) -> tuple[Arc, Arc] | None:
    r"""Return two arcs that lead to a pose and join without a corner, a biarc.

    Of the pairs that do, it is the one whose tangents, from each end to where they meet, are of
    equal length d, the positive root of

    .. math::
        2 (1 - t_0 \cdot t_1) d^2 + 2 d\, p \cdot (t_0 + t_1) - p \cdot p = 0

    with the place p and the unit vectors t of the headings at both ends.

    Args:
        x: Distance ahead, not zero together with y [m].
        y: Distance to the left [m].
        heading: Heading at the end [rad].

    Returns:
        The two; None where there are none, as for a place straight behind with heading zero.
    """
    place, along = np.array([x, y]), np.array([np.cos(heading), np.sin(heading)])
    ahead = np.array([1.0, 0.0])
    both, bend = float(place @ (ahead + along)), 2 * (1 - float(ahead @ along))
    square = float(place @ place)
    if bend > 1e-9:
        d = (-both + float(np.sqrt(both**2 + bend * square))) / bend
    elif both > 0:
        d = square / (2 * both)
    else:
        return None
    joint = 0.5 * (place + d * (ahead - along))
    first = arc_to(*joint.tolist())
    if first is None:
        return None
    c, s = np.cos(first.turn), np.sin(first.turn)
    to_x, to_y = place - joint
    second = arc_to(float(c * to_x + s * to_y), float(c * to_y - s * to_x))
    return None if second is None else (first, second)


def arc_straight_arc_to(x: float, y: float, heading: float, radius: float) -> tuple[Arc, Arc, Arc]:
    """Return the shortest arc, straight and arc, of one radius, that lead to a pose.

    These are the Dubins paths of the kind arc-straight-arc; those of three arcs are not tried.

    Args:
        x: Distance ahead [m].
        y: Distance to the left [m].
        heading: Heading at the end [rad].
        radius: Radius of both arcs [m].
    """
    sides = [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)]
    found = [_between_circles(x, y, heading, radius, *pair) for pair in sides]
    return min((each for each in found if each is not None), key=lambda arcs: sum(
        arc.length for arc in arcs
    ))  # fmt: skip


def _between_circles(
    x: float, y: float, heading: float, radius: float, first: float, second: float
) -> tuple[Arc, Arc, Arc] | None:
    """Return arc, straight and arc to a pose, with arcs that turn to given sides.

    None where circles of different sides overlap, which leaves no straight between them.

    Args:
        x: Distance ahead [m].
        y: Distance to the left [m].
        heading: Heading at the end [rad].
        radius: Radius of both arcs [m].
        first: Side to which the first arc turns: 1 left, -1 right.
        second: Side to which the last arc turns.
    """
    to_x = x - second * radius * np.sin(heading)  # from one circle's centre to the other's
    to_y = y + second * radius * np.cos(heading) - first * radius
    far, along = float(np.hypot(to_x, to_y)), float(np.arctan2(to_y, to_x))
    if first == second:
        straight = far
    elif far >= 2 * radius:
        straight = float(np.sqrt(far**2 - 4 * radius**2))
        along += first * float(np.arctan2(2 * radius, straight))
    else:
        return None
    begin, end = _turned(along, first), _turned(heading - along, second)
    return (
        Arc(radius * abs(begin), begin), Arc(straight, 0.0), Arc(radius * abs(end), end),
    )  # fmt: skip


def _turned(angle: float, side: float) -> float:
    """Return the turn to a side, 1 left and -1 right, equal to an angle modulo 2 pi [rad].

    Less than a whole turn, and positive to the left; 0 for a whole turn but for rounding.
    """
    turn = (side * angle) % (2 * np.pi)
    return 0.0 if turn > 2 * np.pi - 1e-6 else side * turn
