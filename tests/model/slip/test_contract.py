# SPDX-License-Identifier: MIT
"""What every slip law owes, asked of every law and every set of its options."""

from functools import cache

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip import LAWS, Brush, CoulombStribeck, MagicFormula

WITH_OPTIONS = (
    MagicFormula(curvature="constant"),
    MagicFormula(curvature=0.0),
    MagicFormula(load_sensitivity=True, reference_load=6.63),
    CoulombStribeck(stribeck=False),
    Brush(),
)
LAWS_UNDER_TEST = (*(law() for law in LAWS.values()), *WITH_OPTIONS)

# Kept off the edges of each support, where a curve is too sharp for finite differences.
RANGES = {
    "slip_stiffness": (1.0, 60.0),
    "shape": (1.05, 1.56),
    "friction": (0.05, 2.0),
    "peak_slip_per_load": (0.002, 0.05),
    "curvature": (-8.0, 0.95),
    "friction_load_exponent": (-0.3, 0.3),
    "stiffness_load_exponent": (-0.3, 0.3),
    "kinetic_ratio": (0.05, 0.95),
    "stribeck_slip": (0.01, 1.0),
}


def interior(parameter):
    """Return bounds well inside a parameter's support."""
    lower, upper = parameter.lower, min(parameter.upper, parameter.lower + 10)
    inside = (0.9 * lower + 0.1 * upper, 0.1 * lower + 0.9 * upper)
    return RANGES.get(parameter.name, inside)


LOADS = st.floats(0.5, 30.0)
SLIPS = st.floats(-2.0, 2.0)
LOG_SPACED = np.geomspace(1e-4, 10, 4001)


def laws_with_values(laws=LAWS_UNDER_TEST):
    """Draw a law and values inside its support."""
    return st.sampled_from(laws).flatmap(
        lambda law: st.tuples(
            st.just(law), st.tuples(*(st.floats(*interior(p)) for p in law.parameters))
        )
    )


def stiffness(law, load, values):
    """Slope at zero slip for each newton of load."""
    if getattr(law, "load_sensitivity", False):
        return values[0] * (load / law.reference_load) ** values[-1]
    return values[0]


def friction(law, load, values):
    """Peak traction over load."""
    mu = values[[parameter.name for parameter in law.parameters].index("friction")]
    if getattr(law, "load_sensitivity", False):
        return mu * (load / law.reference_load) ** values[-2]
    return mu


@given(laws_with_values(), LOADS)
def test_zero_slip_gives_zero_force(drawn, load):
    law, values = drawn
    assert law.force(0.0, load, values) == 0.0


@given(laws_with_values(), SLIPS, LOADS)
def test_force_is_odd_in_slip(drawn, slip, load):
    law, values = drawn
    assert law.force(-slip, load, values) == -law.force(slip, load, values)


@given(laws_with_values(), SLIPS, LOADS)
def test_force_never_exceeds_friction_times_load(drawn, slip, load):
    law, values = drawn
    limit = friction(law, load, values) * load
    assert abs(law.force(slip, load, values)) <= limit * (1 + 1e-12)


@given(laws_with_values(), st.floats(-1.0, 1.0), LOADS)
def test_slip_derivative_agrees_with_finite_differences(drawn, slip, load):
    law, values = drawn
    scale = friction(law, load, values) / stiffness(law, load, values)
    step = 1e-5 * min(scale, float(law.peak_slip(load, values)), 0.01)
    ends = law.force(np.array([slip - step, slip + step]), load, values)
    expected = (ends[1] - ends[0]) / (2 * step)
    derivative = law.slip_derivative(slip, load, values)
    assert derivative == pytest.approx(expected, rel=2e-4, abs=2e-4 * values[0] * load)


@given(laws_with_values(), LOADS)
def test_slope_at_zero_slip_is_slip_stiffness_times_load(drawn, load):
    law, values = drawn
    expected = stiffness(law, load, values) * load
    assert law.slip_derivative(0.0, load, values) == pytest.approx(expected)


@given(laws_with_values(), LOADS)
def test_force_at_the_peak_slip_is_friction_times_load(drawn, load):
    law, values = drawn
    peak = law.force(law.peak_slip(load, values), load, values)
    assert peak == pytest.approx(friction(law, load, values) * load)


@given(laws_with_values(), LOADS)
def test_force_rises_to_its_peak_and_never_after(drawn, load):
    law, values = drawn
    peak = law.peak_slip(load, values)
    slope = law.slip_derivative(LOG_SPACED, load, values)
    tolerance = 1e-9 * values[0] * load
    assert np.all(slope[peak > LOG_SPACED] >= -tolerance)
    assert np.all(slope[peak < LOG_SPACED] <= tolerance)


@given(laws_with_values(), LOADS)
def test_values_inside_the_support_are_valid(drawn, load):
    law, values = drawn
    assert law.valid(load, values)


@given(laws_with_values((CoulombStribeck(), Brush(), MagicFormula("constant"))), SLIPS, LOADS)
def test_force_is_proportional_to_load_where_the_shape_is_constant(drawn, slip, load):
    law, values = drawn
    assert law.force(slip, 3 * load, values) == pytest.approx(3 * law.force(slip, load, values))


@given(laws_with_values())
def test_force_vanishes_with_load(drawn):
    law, values = drawn
    assert np.all(np.abs(law.force([-1.0, 0.0, 0.01, 1.0], 1e-6, values)) < 1e-3)


@pytest.mark.parametrize("law", LAWS_UNDER_TEST, ids=repr)
def test_ensemble_of_values_equals_a_loop_over_walkers(law):
    rng = np.random.default_rng(20)
    walkers = np.array(
        [[rng.uniform(*interior(parameter)) for parameter in law.parameters] for _ in range(5)]
    )
    slip, load = np.linspace(-0.5, 1.0, 7), np.linspace(1.0, 12.0, 7)
    values = walkers.T[:, :, None]
    for method in (law.force, law.slip_derivative):
        together = method(slip, load, values)
        assert together.shape == (5, 7)
        np.testing.assert_array_equal(together, [method(slip, load, one) for one in walkers])
    for method in (law.valid, law.peak_slip):
        together = np.broadcast_to(method(load, values), (5, 7))
        alone = [np.broadcast_to(method(load, one), 7) for one in walkers]
        np.testing.assert_allclose(together, alone)


@cache
def compiled(at_load, traction_over_load):
    @numba.njit(error_model="numpy")
    def force(slip, load, constants):
        return load * traction_over_load(slip, *at_load(load, constants))

    return force


@pytest.mark.parametrize("law", LAWS_UNDER_TEST, ids=repr)
def test_compiled_loops_compute_the_same_force(law):
    rng = np.random.default_rng(1)
    values = [rng.uniform(*interior(parameter)) for parameter in law.parameters]
    slip = np.concatenate([np.zeros(1), rng.uniform(-0.5, 0.5, 300)])
    slip[:100] *= 1e-4
    slip[100:110] *= 1e3
    load = rng.uniform(1e-3, 20.0, slip.shape)
    load[:20] = 1e-9
    made = law.compiled_force(values)
    force = compiled(made.at_load, made.traction_over_load)
    found = [force(*each, made.constants) for each in zip(slip, load, strict=True)]
    np.testing.assert_allclose(found, law.force(slip, load, values), rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("law", LAWS_UNDER_TEST, ids=repr)
def test_parameters_are_named_once_and_described(law):
    names = [parameter.name for parameter in law.parameters]
    assert len(set(names)) == len(names)
    assert {"slip_stiffness", "friction"} <= set(names)
    assert all(p.lower < p.upper and p.meaning and p.unit for p in law.parameters)


def test_every_law_is_under_its_own_name():
    assert {name: law.name for name, law in LAWS.items()} == {name: name for name in LAWS}
