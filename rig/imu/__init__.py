# SPDX-License-Identifier: MIT
"""Inertial measurement units that record the robot's orientation in addition to its legs."""
