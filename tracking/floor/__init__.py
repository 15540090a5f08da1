# SPDX-License-Identifier: MIT
"""Marks on the floor with measured positions, and camera poses fitted to them."""

from tracking.floor.edge_spread import EDGE_SPREADS, EdgeSpread
from tracking.floor.locate import FloorView, locate_camera
from tracking.floor.marks import FloorMap, FloorMarker, FloorPoint
from tracking.floor.refine import FloorFit, Stand, refine_floor, split_stands

__all__ = [
    "EDGE_SPREADS",
    "EdgeSpread",
    "FloorFit",
    "FloorMap",
    "FloorMarker",
    "FloorPoint",
    "FloorView",
    "Stand",
    "locate_camera",
    "refine_floor",
    "split_stands",
]
