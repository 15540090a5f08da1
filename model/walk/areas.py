# SPDX-License-Identifier: MIT
"""Areas of the ground with slip laws of their own, for the compiled loop of the walk."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba.extending import overload
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import inlined
from model.errors import DomainError
from model.walk.traction import TractionTable


class AreaTractions(NamedTuple):
    """Slip laws of the ground and of areas on it, stacked for the compiled loop.

    Law 0 is that of the ground outside of all areas. Attributes but the first three are those of
    `TractionTable` for each of the k laws, all on the same m loads.

    Attributes:
        corners: Corners of all polygons, one after the other, shape (v, 2) [m].
        first: Index of each area's first corner, then v, shape (k,) as there are k - 1 areas.
        bristle: Whether toes stick like springs; the same for all laws.
        log_load: Shape (m,) [log N].
        scale: Shape (k,) [-].
        step: Shape (k,) [-].
        phi: Shape (k, m, n) [-].
        slope: Shape (k, m, n) [-].
        toe: Shape (k, m) [-].
        by_velocity: Shape (k,).
        speed_scale: Shape (k,) [m/s].
        lateral_grip: Shape (k,) [-].
        lateral_stiffness: Shape (k,) [-].
    """

    corners: Array
    first: NDArray[np.int64]
    bristle: bool
    log_load: Array
    scale: Array
    step: Array
    phi: Array
    slope: Array
    toe: Array
    by_velocity: NDArray[np.bool_]
    speed_scale: Array
    lateral_grip: Array
    lateral_stiffness: Array


@dataclass(frozen=True)
class Area:
    """An area of the ground with a slip law of its own.

    Attributes:
        polygon: Corners in order, without crossing edges, shape (v, 2) [m].
        table: The slip law.

    Raises:
        DomainError: The polygon has fewer than three corners, none of its corners is finite, its
            area is zero, or its edges cross.
    """

    polygon: Array
    table: TractionTable

    def __post_init__(self) -> None:
        """Check the polygon."""
        require_polygon(self.polygon)


def require_polygon(polygon: Array) -> None:
    """Check that corners are those of a polygon that encloses one area.

    Args:
        polygon: Corners in order, shape (v, 2) [m].

    Raises:
        DomainError: There are fewer than three corners, one is not finite or given twice in a row,
            the area is zero, or edges cross; the message says which.
    """
    n = len(polygon)
    if n < 3 or polygon.shape != (n, 2) or not np.isfinite(polygon).all():
        raise DomainError(f"found {n} corners; expected three or more of finite x and y")
    after = np.roll(polygon, -1, axis=0)
    same = np.flatnonzero(np.all(polygon == after, axis=1))
    if len(same):
        x, y = polygon[same[0]]
        raise DomainError(
            f"corner {same[0] + 1}, x {x:g}, y {y:g} m, is the same as the next one; give each "
            "corner once, the first one not again at the end"
        )
    for i in range(n):
        for j in range(i + 2, n - (i == 0)):
            if _cross(polygon[i], after[i], polygon[j], after[j]):
                raise DomainError(
                    f"the edges from corner {i + 1} and from corner {j + 1} cross; give the "
                    "corners in the order in which one walks around the area"
                )
    if abs(np.sum(polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0])) < 1e-12:
        raise DomainError("the corners lie on one line; expected them to enclose an area")


def _cross(a: Array, b: Array, c: Array, d: Array) -> bool:
    """Return whether the segments from a to b and from c to d have a common inner point."""

    def side(p: Array, q: Array, r: Array) -> float:
        """Return twice the signed area of the triangle p, q, r: the side of pq that r is on."""
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def with_areas(table: TractionTable, areas: Sequence[Area]) -> TractionTable | AreaTractions:
    """Stack the slip laws of the ground and of areas on it; without areas return the ground's.

    Args:
        table: The slip law outside of the areas.
        areas: The areas; where some overlap the last one counts.

    Raises:
        DomainError: Toes stick like springs in some laws only, or laws are tabulated at different
            loads.
    """
    if not areas:
        return table
    tables = [table, *(area.table for area in areas)]
    if len({each.bristle for each in tables}) > 1:
        raise DomainError("toes are to stick like springs on some areas only; use one law of toes")
    loads = max((each.log_load for each in tables), key=len)
    for each in tables:
        if len(each.log_load) > 1 and not np.allclose(each.log_load, loads):
            raise DomainError("the slip laws of areas are tabulated at different loads; use one "
                              "weight for all")  # fmt: skip
    rows, columns = len(loads), table.phi.shape[1]
    return AreaTractions(
        corners=np.concatenate([np.asarray(area.polygon, dtype=float) for area in areas]),
        first=np.cumsum([0, *(len(area.polygon) for area in areas)]),
        bristle=table.bristle,
        log_load=loads,
        scale=np.array([each.scale for each in tables]),
        step=np.array([each.step for each in tables]),
        phi=np.stack([np.broadcast_to(each.phi, (rows, columns)) for each in tables]),
        slope=np.stack([np.broadcast_to(each.slope, (rows, columns)) for each in tables]),
        toe=np.stack([np.broadcast_to(each.toe, (rows,)) for each in tables]),
        by_velocity=np.array([each.by_velocity for each in tables]),
        speed_scale=np.array([each.speed_scale for each in tables]),
        lateral_grip=np.array([each.lateral_grip for each in tables]),
        lateral_stiffness=np.array([each.lateral_stiffness for each in tables]),
    )


@inlined
def area_at(areas, x, y):
    """Return the number of the area at a place, from 1, or 0 outside of all areas.

    Args:
        areas: The areas with their laws, `AreaTractions`.
        x: x of the place [m].
        y: y of the place [m].
    """
    corners, first = areas.corners, areas.first
    for k in range(len(first) - 1, 0, -1):
        inside = False
        j = first[k] - 1
        for i in range(first[k - 1], first[k]):
            # a line from the place along x crosses the edge from corner j to corner i
            if (corners[i, 1] > y) != (corners[j, 1] > y):
                share = (y - corners[i, 1]) / (corners[j, 1] - corners[i, 1])
                if x < corners[i, 0] + share * (corners[j, 0] - corners[i, 0]):
                    inside = not inside
            j = i
        if inside:
            return k
    return 0


def law_at(table, p, place):
    """Return the slip law at a contact: that of its area, or the only one.

    Args:
        table: A slip law, or the laws of several areas.
        p: Position of the body, shape (3,) [m].
        place: Contact from the body's centre, shape (3,) [m].
    """
    if isinstance(table, TractionTable):
        return table
    return _law(table, area_at(table, p[0] + place[0], p[1] + place[1]))


@overload(  # as `inlined`; numba's type stubs lack the option `_nrt`
    law_at,
    jit_options={"error_model": "numpy", "forceinline": True, "_nrt": False},  # pyright: ignore[reportArgumentType]
)
def _law_at(table, p, place):
    """Choose `law_at` for the compiled loop by type: a single law costs nothing."""
    if getattr(table, "instance_class", None) is TractionTable:
        return lambda table, p, place: table
    return lambda table, p, place: _compiled_law(
        table, area_at(table, p[0] + place[0], p[1] + place[1])
    )


def _law(areas, k):
    """Return the law of index k of an `AreaTractions` as a `TractionTable`."""
    return TractionTable(
        areas.log_load, areas.scale[k], areas.step[k], areas.phi[k], areas.slope[k], areas.toe[k],
        areas.by_velocity[k], areas.speed_scale[k], areas.bristle, areas.lateral_grip[k],
        areas.lateral_stiffness[k],
    )  # fmt: skip


_compiled_law = inlined(_law)
