# SPDX-License-Identifier: MIT
"""Camera calibration, printed tracking kit, and clock to photograph."""
