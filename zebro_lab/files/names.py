# SPDX-License-Identifier: MIT
"""File names used by more than one room."""

from typing import Final

PATH_CSV: Final = "path.csv"
"""The path of a walk folder, one row per time step."""
