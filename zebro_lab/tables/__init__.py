# SPDX-License-Identifier: MIT
"""Read CSV, Excel and Parquet tables with column maps and units into arrays in SI."""
