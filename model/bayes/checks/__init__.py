# SPDX-License-Identifier: MIT
"""Checks of a fit against its data: what passed, what failed and what these data cannot test."""
