# SPDX-License-Identifier: MIT
"""Simulated walks before a camera, of which everything that a lab is told has an error."""
