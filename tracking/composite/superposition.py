# SPDX-License-Identifier: MIT
"""Sum of one robot's picture at several poses, and least-squares solution for that picture."""

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, cg

from model.arrays import Array
from tracking.composite.body_raster import BodyRaster

_DAMPING = 0.02


def superposed(body: BodyRaster, poses: Array, robot: NDArray[np.float32]) -> NDArray[np.float32]:
    """Compute the sum of the robot's picture drawn at each of several poses.

    Args:
        body: The robot's raster.
        poses: x, y and yaw of the exposures, shape (n, 3) [m, m, rad].
        robot: The robot's picture on the raster of `body`, shape (m, k, 3).

    Returns:
        Sum on the plane's raster, shape (rows, columns, 3); 0 where there is no exposure.
    """
    total = np.zeros((*body.plane.seen_px.shape[:2], 3), np.float32)
    for pose in poses:
        window, laid = body.laid(robot, pose)
        total[window] += laid
    return total


def solve_robot(
    body: BodyRaster, poses: Array, picture: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Solve for the robot's picture whose sum at all poses is nearest to a picture.

    Damped least squares by conjugate gradients. What the exposures do not determine is held near
    zero. The mean of the colours at all poses is not enough: where exposures repeat by a steady
    step, a pattern that alternates with it shows only at the two ends of the walk. For a single
    pose it is the picture there.

    Args:
        body: The robot's raster.
        poses: x, y and yaw of the exposures, shape (n, 3) [m, m, rad].
        picture: Difference of the photograph from the floor, on the plane's raster, or its
            high-pass filtered detail, shape (rows, columns, 3).

    Returns:
        The robot's picture on the raster of `body`, shape (m, k, 3).
    """
    seen = np.mean([body.read(picture, pose) for pose in poses], axis=0)
    shape, columns_rows = seen.shape, seen.shape[1::-1]
    shifts = [
        body.between(pose, other)
        for k, pose in enumerate(poses)
        for other in np.delete(poses, k, axis=0)
    ]

    def normal(values: Array) -> Array:
        """Multiply by the damped normal matrix: the picture moved by all pairs of poses, summed."""
        robot = values.reshape(shape).astype(np.float32)
        total = (1 + _DAMPING) * robot
        for shift in shifts:
            flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
            total += cv2.warpAffine(robot, shift, columns_rows, flags=flags) / len(poses)
        return total.ravel().astype(float)

    if len(poses) == 1:
        return seen.astype(np.float32)
    operator = LinearOperator((seen.size, seen.size), matvec=normal, dtype=float)  # pyright: ignore[reportCallIssue] # SciPy's documented arguments
    solved, _ = cg(operator, seen.ravel().astype(float), rtol=2e-3, maxiter=40)
    return solved.reshape(shape).astype(np.float32)
