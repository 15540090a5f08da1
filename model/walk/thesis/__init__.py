# SPDX-License-Identifier: MIT
"""The source's hybrid dynamic model of tripod walking, as printed, with its faults."""

from model.walk.thesis.legs import SwitchedLegs
from model.walk.thesis.traction import (
    SOURCE_TRACTION,
    Traction,
    law_traction,
    paired_sum,
    table_traction,
)
from model.walk.thesis.walk import ThesisOptions, walk_thesis

__all__ = [
    "SOURCE_TRACTION",
    "SwitchedLegs",
    "ThesisOptions",
    "Traction",
    "law_traction",
    "paired_sum",
    "table_traction",
    "walk_thesis",
]
