# SPDX-License-Identifier: MIT
"""Fit leg offsets and floor parameters to tracked walks; predict each walk from the others."""
