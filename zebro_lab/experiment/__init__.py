# SPDX-License-Identifier: MIT
"""Experiments of the slip rig on disk: emergency latch, finished points, keys of the terminal."""
