# SPDX-License-Identifier: MIT
"""Walks on flat ground, several side by side in vector registers."""
