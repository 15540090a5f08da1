# SPDX-License-Identifier: MIT
"""Design of further rig runs: which slips, loads and durations tell most of a target."""
