# SPDX-License-Identifier: MIT
"""Fit legs and floor to tracked walks; predict each walk from the others."""
