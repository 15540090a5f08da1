# SPDX-License-Identifier: MIT
"""Measure in rounds, each where the last calibration says it tells most: `rig run --adaptive`."""
