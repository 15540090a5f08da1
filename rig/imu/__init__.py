# SPDX-License-Identifier: MIT
"""Inertial measurement units that record the robot's orientation beside its legs."""
