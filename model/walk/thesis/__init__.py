# SPDX-License-Identifier: MIT
"""The thesis's hybrid dynamic model of tripod walking, as printed, with its faults."""

from model.walk.thesis.legs import SwitchedLegs
from model.walk.thesis.path import ThesisPath
from model.walk.thesis.traction import (
    THESIS_TRACTION,
    Traction,
    law_traction,
    paired_sum,
    table_traction,
)
from model.walk.thesis.walk import ThesisOptions, walk_thesis

__all__ = [
    "THESIS_TRACTION",
    "SwitchedLegs",
    "ThesisOptions",
    "ThesisPath",
    "Traction",
    "law_traction",
    "paired_sum",
    "table_traction",
    "walk_thesis",
]
