# SPDX-License-Identifier: MIT
"""Names of files that more than one room reads or writes."""

from typing import Final

PATH_CSV: Final = "path.csv"
"""The path of a walk folder, one row a moment."""
