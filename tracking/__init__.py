# SPDX-License-Identifier: MIT
"""Photographs in, walked path out."""
