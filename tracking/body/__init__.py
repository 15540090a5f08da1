# SPDX-License-Identifier: MIT
"""The robot without a marker: its own picture, annotated once, is found in every photograph."""

from tracking.body.align import Alignment, align
from tracking.body.heading import resolve_headings
from tracking.body.search import BodyCandidates, find_body
from tracking.body.template import BodyTemplate, TopPlate, make_template

__all__ = [
    "Alignment",
    "BodyCandidates",
    "BodyTemplate",
    "TopPlate",
    "align",
    "find_body",
    "make_template",
    "resolve_headings",
]
