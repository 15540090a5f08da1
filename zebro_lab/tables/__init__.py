# SPDX-License-Identifier: MIT
"""Read CSV, Excel, MATLAB and Parquet tables with column maps and units into arrays in SI."""
