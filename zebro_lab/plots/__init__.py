# SPDX-License-Identifier: MIT
"""Figures of calibrations, walks, tracks and validations from arrays, without pyplot."""

from zebro_lab.files.atomic import uninterrupted

with uninterrupted():  # matplotlib has C extensions
    from zebro_lab.plots.laws import slip_laws
    from zebro_lab.plots.noise import residuals
    from zebro_lab.plots.posterior import corner, traces
    from zebro_lab.plots.sheet import add_to_title, parameter_labels, save
    from zebro_lab.plots.slip import slip_curves
    from zebro_lab.plots.slip_law import slip_surface

__all__ = [
    "add_to_title",
    "corner",
    "parameter_labels",
    "residuals",
    "save",
    "slip_curves",
    "slip_laws",
    "slip_surface",
    "traces",
]
