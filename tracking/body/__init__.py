# SPDX-License-Identifier: MIT
"""Markerless tracking: find the robot by a template annotated in one photograph."""

from tracking.body.align import Alignment, align
from tracking.body.annotated import AnnotatedPose
from tracking.body.heading import resolve_headings
from tracking.body.plate_edges import RefinedCorners, refine_corners
from tracking.body.search import BodyCandidates, find_body, floor_in_view, match_turned
from tracking.body.template import (
    BodyTemplate,
    TopPlate,
    make_template,
    pixel_on_top,
)

__all__ = [
    "Alignment",
    "AnnotatedPose",
    "BodyCandidates",
    "BodyTemplate",
    "RefinedCorners",
    "TopPlate",
    "align",
    "find_body",
    "floor_in_view",
    "make_template",
    "match_turned",
    "pixel_on_top",
    "refine_corners",
    "resolve_headings",
]
