# SPDX-License-Identifier: MIT
"""Run folders: read and write them, list runs, exclude runs, decode signals, plot."""
