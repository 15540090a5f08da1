# SPDX-License-Identifier: MIT
"""Experiments of the slip rig that run themselves: plan, bench, guards, run."""
