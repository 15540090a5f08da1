# SPDX-License-Identifier: MIT
"""Hardware: the slip rig and the robot's leg-angle stream, real and simulated."""
