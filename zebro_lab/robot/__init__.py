# SPDX-License-Identifier: MIT
"""The robot: its file, its legs' and IMU's tables, the gaits that a command line asks for."""
