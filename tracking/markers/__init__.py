# SPDX-License-Identifier: MIT
"""Square markers (ArUco, AprilTag): geometry, and detection to a few hundredths of a pixel."""

from tracking.markers.dictionaries import (
    DICTIONARIES,
    dictionary_named,
    guess_dictionary,
    marker_family,
)
from tracking.markers.find import Region, find_markers, neighbourhood
from tracking.markers.refine import Sighting, refine_corners
from tracking.markers.square import (
    edge_growth,
    marker_corners,
    marker_picture,
    square_homography,
)

__all__ = [
    "DICTIONARIES",
    "Region",
    "Sighting",
    "dictionary_named",
    "edge_growth",
    "find_markers",
    "guess_dictionary",
    "marker_corners",
    "marker_family",
    "marker_picture",
    "neighbourhood",
    "refine_corners",
    "square_homography",
]
