# SPDX-License-Identifier: MIT
"""The robot's leg-angle stream and its commands, real and simulated."""
