# SPDX-License-Identifier: MIT
"""Synthetic grain of a wooden floor."""

import cv2
import numpy as np

WIDTH = 30.0  # px


def grain(rng, shape=(400, 480)):
    """Draw planks: noise with a long correlation along rows and a short one across."""
    noise = rng.normal(0, 1, (*shape, 3)).astype(np.float32)
    long = cv2.GaussianBlur(noise, (0, 0), sigmaX=12, sigmaY=0.8)
    return 10 * long / long.std() + rng.normal(0, 0.5, noise.shape).astype(np.float32)
