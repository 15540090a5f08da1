# SPDX-License-Identifier: MIT
"""Suggest further points of the rig: which slips and loads tell most of a target."""
