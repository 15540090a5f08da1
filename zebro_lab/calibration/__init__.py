# SPDX-License-Identifier: MIT
"""Calibrate a slip law from rig data; the calibration folder and what reads it."""
