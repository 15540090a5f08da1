# SPDX-License-Identifier: MIT
"""Tables of other people: CSV and Parquet files, column maps, units, into arrays in SI."""
