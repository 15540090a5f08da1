# SPDX-License-Identifier: MIT
"""The floor's marks, and the camera's pose over them."""

from tracking.floor.locate import FloorView, locate_camera
from tracking.floor.marks import FloorMap, FloorMarker, FloorPoint
from tracking.floor.refine import FloorFit, Stand, refine_floor
from tracking.floor.stands import split_stands

__all__ = [
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
