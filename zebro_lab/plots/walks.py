# SPDX-License-Identifier: MIT
"""Plot prior and posterior of legs and floor after walks, for each parameter."""

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import norm

from model.counted import counted
from model.walk_fit.posterior import Contraction, WalkPosterior
from model.walk_fit.prior import UNITS
from zebro_lab.files.units import shown_unit
from zebro_lab.plots.sheet import BLUE, legend_below, new_figure, styled

_COLUMNS = 4


@styled
def walk_parameters(posterior: WalkPosterior, *, simulated: bool) -> Figure:
    """Draw prior and posterior density of every parameter of legs and floor.

    Args:
        posterior: The posterior of legs and floor.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure, a panel for each parameter; titles name those that the walks do not constrain.
    """
    parameters = posterior.contractions()
    rows = -(-len(parameters) // _COLUMNS)
    title = f"Legs and floor after {counted(len(posterior.walks), 'walk')}: prior and posterior"
    figure = new_figure(title, simulated, width=9.0, height=1.9 * rows + 0.8)
    axes = figure.subplots(rows, _COLUMNS, squeeze=False).ravel()
    values = posterior.with_wrong_legs()
    for panel, each, unit, drawn in zip(axes, parameters, UNITS, values.T, strict=False):
        scale, shown = shown_unit(unit)
        x = np.linspace(-3 * each.prior_sd, 3 * each.prior_sd, 121)
        panel.plot(
            scale * x, norm.pdf(x, scale=each.prior_sd) / scale, color="0.5", lw=1.0, label="prior"
        )
        panel.hist(
            scale * drawn, bins=30, weights=posterior.weight, density=True, color=BLUE, alpha=0.5,
            label="posterior",
        )  # fmt: skip
        panel.set(xlabel=f"[{shown}]", yticks=[])
        panel.set_title(_title(each), loc="left")
    for panel in axes[len(parameters) :]:
        panel.set_axis_off()
    legend_below(figure, columns=2)
    return figure


def _title(each: Contraction) -> str:
    """Return a parameter's name, with a remark unless it is informed (`Contraction.informed`)."""
    name = each.name.replace("_", " ")
    return name if each.informed else f"{name}: not informed"
