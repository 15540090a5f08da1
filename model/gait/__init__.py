# SPDX-License-Identifier: MIT
"""Gaits: which leg is where, when."""
