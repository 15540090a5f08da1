# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.compiled import compiled
from model.slip import Brush, CoulombStribeck, MagicFormula, SidedLaw
from model.slip.lane_force import lane_law, law_at_load, side_at_slip
from model.slip.lanes import LANES, put, row

LAWS = [
    MagicFormula(),
    MagicFormula("constant"),
    MagicFormula(-0.3),
    MagicFormula("peak", load_sensitivity=True, reference_load=6.0),
    MagicFormula("constant", load_sensitivity=True, reference_load=6.0),
    Brush(),
    CoulombStribeck(),
    CoulombStribeck(stribeck=False),
    SidedLaw(MagicFormula("constant", load_sensitivity=True, reference_load=6.0)),
    SidedLaw(Brush()),
]


@compiled
def forces(kind, sensitive, reference, sided, A, slip, load, found):
    for i in range(len(slip)):
        one = row(load, i)
        at_load = law_at_load(kind, sensitive, reference, A, one)
        put(found, i, side_at_slip(sided, kind, A, at_load, row(slip, i), one))


def typical(law, rng):
    """Return parameter vectors of a law, one a lane, shape (LANES, k)."""
    known = {
        "slip_stiffness": 20.0, "shape": 1.5, "friction": 0.4, "peak_slip_per_load": 0.0066,
        "curvature": -0.5, "friction_load_exponent": -0.1, "stiffness_load_exponent": 0.2,
        "kinetic_ratio": 0.8, "stribeck_slip": 0.1, "side_stiffness": 0.3, "side_friction": -0.2,
    }  # fmt: skip
    middle = np.array([known[p.name] for p in law.parameters])
    return middle * rng.uniform(0.9, 1.1, (LANES, len(middle)))


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_forces_in_lanes_are_the_laws_own(law):
    rng = np.random.default_rng(1)
    values = typical(law, rng)
    slip = np.concatenate([rng.uniform(-0.5, 0.5, (500, LANES)), np.zeros((1, LANES))])
    slip[:100] *= 1e-4
    slip[100:110] *= 1e3
    load = rng.uniform(1e-3, 20.0, slip.shape)
    load[:20] = 1e-9
    known = lane_law(law, values)
    assert known is not None
    found = np.empty_like(slip)
    kind = known.kind, known.sensitive, known.reference, known.sided
    forces(*kind, known.coefficients, slip, load, found)
    exact = law.force(slip, load, values.T)
    np.testing.assert_allclose(found, exact, rtol=1e-11, atol=1e-12)


def test_a_law_of_ones_own_has_no_coefficients():
    class Own:
        name = "own"

    assert lane_law(Own(), np.zeros((1, 2))) is None
