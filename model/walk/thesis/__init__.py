# SPDX-License-Identifier: MIT
"""The thesis's hybrid dynamic model of tripod walking, as printed, with its faults."""

from model.walk.thesis.legs import SWITCHES, Switch, SwitchedLegs
from model.walk.thesis.path import ThesisPath
from model.walk.thesis.traction import (
    THESIS_TRACTION,
    Traction,
    law_traction,
    paired_sum,
    table_traction,
)
from model.walk.thesis.walk import ThesisOptions, is_tripod, walk_thesis

__all__ = [
    "SWITCHES",
    "THESIS_TRACTION",
    "Switch",
    "SwitchedLegs",
    "ThesisOptions",
    "ThesisPath",
    "Traction",
    "is_tripod",
    "law_traction",
    "paired_sum",
    "table_traction",
    "walk_thesis",
]
