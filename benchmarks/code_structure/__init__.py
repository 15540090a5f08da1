# SPDX-License-Identifier: MIT
"""Sizes, names and calls of the four packages, measured over their syntax trees."""
