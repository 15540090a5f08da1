# SPDX-License-Identifier: MIT
"""Figures of calibrations, walks, tracks and validations from arrays, without pyplot."""

from zebro_lab.files.atomic import uninterrupted

with uninterrupted():  # matplotlib has C extensions
    from zebro_lab.plots.sheet import save

__all__ = ["save"]
