# SPDX-License-Identifier: MIT
import math
from pathlib import Path

import numpy as np
import pytest
from typer import BadParameter

from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from zebro_lab.adaptive.wanted import parse_wanted
from zebro_lab.adaptive.widths import half_width, require_parameters
from zebro_lab.suggest.target_text import ForceText, ParameterText, WalkText


def test_a_parameter_that_no_law_has_is_refused_with_the_one_it_is_like():
    with pytest.raises(BadParameter, match="did you mean 'friction'"):
        require_parameters([parse_wanted("fricton=0.1")], [THESIS_LAW])
    require_parameters([parse_wanted("friction"), parse_wanted("force@0.1")], [THESIS_LAW])


def test_the_half_width_is_that_of_the_quantiles():
    rng = np.random.default_rng(1)
    values = np.tile(THESIS_VALUES, (20_000, 1))
    values[:, 0] *= 1 + 0.1 * rng.standard_normal(len(values))
    found = half_width(ParameterText("slip_stiffness"), THESIS_LAW, values, ())
    assert found == pytest.approx(1.645 * 0.1 * THESIS_VALUES[0], rel=0.03)
    # At small slip force is stiffness times slip times load, whatever the load.
    force = half_width(ForceText((1e-4,), None), THESIS_LAW, values, (4.0, 8.0))
    assert force == pytest.approx(0.1645, rel=0.03)


def test_of_several_forces_the_widest_counts():
    rng = np.random.default_rng(2)
    values = np.tile(THESIS_VALUES, (4000, 1))
    values[:, 0] *= 1 + 0.1 * rng.standard_normal(len(values))
    each = [half_width(ForceText((s,), 8.0), THESIS_LAW, values, ()) for s in (0.001, 0.5)]
    assert half_width(ForceText((0.001, 0.5), 8.0), THESIS_LAW, values, ()) == max(each)


def test_a_walk_and_a_parameter_of_another_law_have_none():
    values = np.array([THESIS_VALUES])
    assert math.isnan(half_width(WalkText(Path("w")), THESIS_LAW, values, (8.0,)))
    assert math.isnan(half_width(ParameterText("stribeck_slip"), THESIS_LAW, values, (8.0,)))
