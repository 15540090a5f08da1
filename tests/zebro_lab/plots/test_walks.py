# SPDX-License-Identifier: MIT
"""Each parameter of legs and floor has a panel with its prior and posterior."""

import numpy as np
import pytest

from model.walk_fit.prior import NAMES, WrongLeg
from support.walk_posteriors import OFF, posterior_of
from zebro_lab.plots.walks import walk_parameters


def test_every_parameter_has_prior_and_posterior_in_its_unit():
    posterior = posterior_of(WrongLeg(2))
    figure = walk_parameters(posterior, simulated=True)
    panels = [axes for axes in figure.axes if axes.axison]
    assert [axes.get_title(loc="left").removesuffix(": not informed") for axes in panels] == [
        name.replace("_", " ") for name in NAMES
    ]
    for axes, each in zip(panels, posterior.contractions(), strict=True):
        assert (": not informed" in axes.get_title(loc="left")) != each.informed
        x, density = axes.lines[0].get_data()
        assert np.trapezoid(density, x) == pytest.approx(0.997, abs=2e-3)
        area = sum(bar.get_width() * bar.get_height() for bar in axes.patches)
        assert area == pytest.approx(1.0)
        assert axes.get_xlabel().startswith("[")
    leg = panels[2]
    middle = [bar.get_x() + bar.get_width() / 2 for bar in leg.patches if bar.get_height() > 0]
    assert np.mean(middle) == pytest.approx(np.degrees(OFF), abs=0.1)
    assert leg.get_xlabel() == "[deg]"
    title = "Legs and floor after 2 walks: prior and posterior (simulated)"
    assert figure.get_suptitle() == title
