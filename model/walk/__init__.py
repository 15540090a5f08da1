# SPDX-License-Identifier: MIT
"""Walks: from leg angles to a path."""
