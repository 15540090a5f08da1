# SPDX-License-Identifier: MIT
"""Import and export: write a column map, import runs from other software, export runs."""
