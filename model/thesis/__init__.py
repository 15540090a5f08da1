# SPDX-License-Identifier: MIT
"""The thesis's hybrid dynamic model of tripod walking, as printed, with its faults."""

from model.thesis.legs import SwitchedLegs
from model.thesis.path import ThesisPath
from model.thesis.traction import (
    THESIS_TRACTION,
    Traction,
    law_traction,
    paired_sum,
    slip_traction,
    table_traction,
)
from model.thesis.walk import ThesisOptions, is_tripod, walk_thesis

__all__ = [
    "THESIS_TRACTION",
    "SwitchedLegs",
    "ThesisOptions",
    "ThesisPath",
    "Traction",
    "is_tripod",
    "law_traction",
    "paired_sum",
    "slip_traction",
    "table_traction",
    "walk_thesis",
]
