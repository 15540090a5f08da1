# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from rig.slip_rig.imperfections import (
    TYPICAL_RIG,
    RigImperfections,
    bump_rise,
    draw_imperfections,
    lag_one_correlation,
    measured_load,
)
from support.true_load import true_load


@pytest.mark.parametrize(
    ("fault", "named"),
    [
        ({"gain_normal": -1.0}, "gain_normal is -1"),
        ({"offset_sd": -0.1}, "offset_sd is -0.1"),
        ({"noise_correlation_time": float("nan")}, "noise_correlation_time is nan"),
    ],
)
def test_impossible_imperfections_are_refused_by_name_and_value(fault, named):
    with pytest.raises(DomainError, match=named):
        RigImperfections(**fault)


@given(
    load=st.floats(0.1, 30),
    traction=st.floats(-15, 15),
    gain=st.floats(-0.5, 0.5),
    bias=st.floats(-1, 1),
    crosstalk=st.floats(-0.5, 0.5),
)
def test_measured_load_and_true_load_are_inverse(load, traction, gain, bias, crosstalk):
    rig = RigImperfections(gain_normal=gain, bias_normal=bias, crosstalk=crosstalk)
    read = measured_load(np.array([load]), np.array([traction]), imperfections=rig)
    back = true_load(read, np.array([traction]), imperfections=rig)
    np.testing.assert_allclose(back, load, rtol=1e-12, atol=1e-12)


def test_drawn_errors_have_the_spread_that_priors_state():
    rng = np.random.default_rng(11)
    rigs = [draw_imperfections(rng) for _ in range(4000)]
    spreads = {"gain_traction": 0.005, "gain_normal": 0.005, "bias_normal": 0.05,
               "crosstalk": 0.005}  # fmt: skip
    for name, sd in spreads.items():
        drawn = np.array([getattr(rig, name) for rig in rigs])
        assert drawn.std() == pytest.approx(sd, rel=0.05)
        assert abs(drawn.mean()) < 4 * sd / np.sqrt(len(rigs))
    assert replace(rigs[0], **dict.fromkeys(spreads, 0.0)) == TYPICAL_RIG


@given(angle=st.floats(-50, 50), width=st.floats(0.05, 2 * np.pi))
def test_the_bump_is_even_periodic_and_bounded(angle, width):
    rise = bump_rise(np.array([angle, -angle, angle + 2 * np.pi]), height=0.6, width=width)
    np.testing.assert_allclose(rise, rise[0], atol=1e-9)
    assert np.all((rise >= 0) & (rise <= 0.6))


@given(st.floats(1e-4, 0.1), st.floats(1e-4, 10))
def test_correlation_over_two_intervals_is_its_square(interval, time):
    once, twice = (lag_one_correlation(k * interval, time) for k in (1, 2))
    assert twice == pytest.approx(once**2, abs=1e-12)
