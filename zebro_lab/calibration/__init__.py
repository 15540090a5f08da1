# SPDX-License-Identifier: MIT
"""Calibrate a slip law from rig data; read and write the calibration folder."""
