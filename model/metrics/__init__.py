# SPDX-License-Identifier: MIT
"""Errors of a predicted path against a tracked one, and calibration of its uncertainty."""
