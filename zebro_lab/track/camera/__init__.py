# SPDX-License-Identifier: MIT
"""Calibrate the camera, print the tracking kit, show the clock to photograph."""
