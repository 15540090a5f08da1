# SPDX-License-Identifier: MIT
"""Calibrate a camera, print the tracking kit, and show a clock to photograph."""
