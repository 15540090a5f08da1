# SPDX-License-Identifier: MIT
"""Record devices into run folders: acquisition, recorder, simulated twins, checks of a machine."""
