# SPDX-License-Identifier: MIT
"""Other people's files: start a column map, import runs, export runs."""
