# SPDX-License-Identifier: MIT
"""Import runs from other software, export runs, and write a column map for a table."""
