# SPDX-License-Identifier: MIT
"""Studies of the slip fit on simulated data: simulation-based calibration and coverage."""
