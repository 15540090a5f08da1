# SPDX-License-Identifier: MIT
"""Samples averaged in blocks, with the errors of their slip."""
