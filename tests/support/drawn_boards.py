# SPDX-License-Identifier: MIT
"""A camera that looks down, and calibration boards as it sees them."""

import numpy as np

from tracking.camera import Camera

LENS = Camera(
    (1280, 960),
    np.array([[1400.0, 0, 630.0], [0, 1395.0, 490.0], [0, 0, 1]]),
    np.array([-0.12, 0.05, 1e-3, -5e-4, 0.01]),
)
