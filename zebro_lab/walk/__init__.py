# SPDX-License-Identifier: MIT
"""Simulate a gait or predict a path from measured leg angles; the walk folder and its band."""
