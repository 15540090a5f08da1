# SPDX-License-Identifier: MIT
"""Tell TUM, KITTI and EuRoC trajectories apart, and order their numbers."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from model.rigid_path import plane_axes, rotations_of_quaternions
from zebro_lab.files.errors import DataError, UnitError
from zebro_lab.files.units import factor_to_si
from zebro_lab.track.trajectory.headers import named_columns
from zebro_lab.track.trajectory.numbers import NumberLines
from zebro_lab.track.trajectory.request import Layout

_POSE: Final = ("t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")
_EUROC: Final = ("t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
_MATRIX: Final = 12
_TOLERANCE: Final = 0.05
"""Largest error of a quaternion's length and of a product of two columns of a rotation."""
_UPRIGHT: Final = 0.1
"""Largest part of a quaternion across the normal of the floor for a body that is upright."""


@dataclass(frozen=True)
class OrderedNumbers:
    """Numbers of a trajectory in a known order.

    Attributes:
        layout: Their layout.
        t: Stamps in the file's unit, shape (n,); None without stamps.
        time_unit: Unit that header or layout state for the stamps.
        position: Positions, shape (n, 3) [m].
        rotation: Rotations, shape (n, 3, 3).
        poses: The numbers of each pose as in the file, shape (n, columns).
    """

    layout: Layout
    t: Array | None
    time_unit: str
    position: Array
    rotation: Array
    poses: Array


def ordered(numbers: NumberLines, stated: Layout | None, *, plane: str) -> OrderedNumbers:
    """Order the numbers of a trajectory by the layout stated, by its header, or by their count.

    Args:
        numbers: The numbers.
        stated: The layout that the user states; None for that of the file.
        plane: Axes of the floor; a body that is upright on it shows whether w is first or last.

    Raises:
        DataError: The layout is not known or does not fit, or a rotation is none.
    """
    count = numbers.values.shape[1]
    if stated is Layout.KITTI or (stated is None and count == _MATRIX and not numbers.header):
        return _matrices(numbers)
    named = {} if stated else named_columns(numbers.header)
    if set(_POSE) <= set(named):
        order = [numbers.header.index(named[name].header) for name in _POSE]
        euroc = order[_POSE.index("qw")] < order[_POSE.index("qx")]
        layout = Layout.EUROC if euroc else Layout.TUM
        return _quaternions(numbers, order, layout, units=[named[n].unit for n in _POSE[:4]])
    layout = stated or (Layout.TUM if count == len(_POSE) and not numbers.separator else None)
    if layout is None or count < len(_POSE) or (layout is Layout.TUM and count > len(_POSE)):
        raise _unknown(numbers, stated)
    columns = _EUROC if layout is Layout.EUROC else _POSE
    order = [columns.index(name) for name in _POSE]
    done = _quaternions(numbers, order, layout)
    if stated is None:
        _require_w_last(numbers, plane)
    return done


def _matrices(numbers: NumberLines) -> OrderedNumbers:
    if numbers.values.shape[1] != _MATRIX:
        raise _unknown(numbers, Layout.KITTI)
    matrix = numbers.values.reshape(-1, 3, 4)
    rotation = matrix[:, :, :3]
    product = np.swapaxes(rotation, 1, 2) @ rotation - np.eye(3)
    wrong = (np.abs(product).max(axis=(1, 2)) > _TOLERANCE) | (np.linalg.det(rotation) < 0)
    if wrong.any():
        raise numbers.fault(
            "numbers 1-3, 5-7 and 9-11 are no rotation matrix; expected lines of a KITTI "
            "trajectory, the first three rows of a 4x4 matrix",
            int(np.argmax(wrong)),
        )
    return OrderedNumbers(Layout.KITTI, None, "s", matrix[:, :, 3], rotation, numbers.values)


def _quaternions(
    numbers: NumberLines, order: list[int], layout: Layout, *, units: list[str | None] | None = None
) -> OrderedNumbers:
    """Take stamp, position and quaternion from the columns `order`, in the order of `_POSE`."""
    t, *position = numbers.values[:, order[:4]].T
    quaternion = numbers.values[:, order[4:]]
    length = np.linalg.norm(quaternion, axis=1)
    wrong = np.abs(length - 1) > _TOLERANCE
    if wrong.any():
        index = int(np.argmax(wrong))
        raise numbers.fault(
            f"quaternion length {length[index]:.4g}; expected {1 - _TOLERANCE} to "
            f"{1 + _TOLERANCE}: check that the order of the columns is that of the layout",
            index,
        )
    whole = bool(np.all(t == np.round(t)))  # as nanoseconds are
    time_unit, *lengths = units or [None] * 4
    factors = [_factor(numbers, unit) for unit in lengths]
    return OrderedNumbers(
        layout=layout,
        t=t,
        time_unit=time_unit or ("ns" if layout is Layout.EUROC and whole else "s"),
        position=np.column_stack(position) * factors,
        rotation=rotations_of_quaternions(quaternion),
        poses=numbers.values[:, order[1:]],
    )


def _factor(numbers: NumberLines, unit: str | None) -> float:
    try:
        return factor_to_si(unit or "m", "m")
    except UnitError as error:
        raise DataError(f"{error}; correct the header", file=numbers.file) from error


def _require_w_last(numbers: NumberLines, plane: str) -> None:
    """Raise where a body stands upright if w is read first, and does not if it is read last."""
    first = np.abs(numbers.values[:, 4:])
    in_plane = np.array(plane_axes(plane))
    if first[:, in_plane].max() > _UPRIGHT >= first[:, 1 + in_plane].max():
        raise DataError(
            "quaternions are upright if their first number is w, and upside down or tilted if the "
            "last is w as in TUM files; give --layout euroc (w first) or --layout tum (w last)",
            file=numbers.file,
        )


def _unknown(numbers: NumberLines, stated: Layout | None) -> DataError:
    count = numbers.values.shape[1]
    if count in (len(_POSE), 17) and stated is None:
        return DataError(
            f"has {count} numbers a line and no header that names them, so that the place of the "
            "quaternion's w is open; give --layout tum (w last) or --layout euroc (w first)",
            file=numbers.file,
        )
    expected = {
        Layout.TUM: "8 (time, position, quaternion)",
        Layout.EUROC: "8 or more (time, position, quaternion)",
        Layout.KITTI: "12 (three rows of a matrix)",
    }
    what = "8 (TUM) or 12 (KITTI)" if stated is None else expected[stated]
    return DataError(
        f"has {count} numbers a line; expected {what}, or a table with a header line (t, x, y, "
        "perhaps yaw, or z and qx, qy, qz, qw)",
        file=numbers.file,
    )
