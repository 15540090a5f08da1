# SPDX-License-Identifier: MIT
"""Geometric contact detection of the legs: the thesis's algorithms of section 3-5."""
