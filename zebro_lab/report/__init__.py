# SPDX-License-Identifier: MIT
"""Render the finished folders of all stages as one HTML page."""
