# SPDX-License-Identifier: MIT
"""Experiments of the slip rig: run folders, journal, emergency latch, finished points, terminal."""
