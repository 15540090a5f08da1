# SPDX-License-Identifier: MIT
import numba
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from model.errors import DomainError
from model.leg import ROLLING, TOE
from model.leg_state import scaled_table
from model.slip import Brush, CoulombStribeck, MagicFormula, SlipDefinition, convert_slip
from model.walk.traction import VelocityCoulomb, law_table
from model.walk.traction_lookup import table_value, traction_secant

WEIGHT = 21.3
SOURCE = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
LAWS = [
    (MagicFormula("peak"), SOURCE),
    (MagicFormula("constant"), np.array([20.0, 1.5, 0.4, -0.5])),
    (MagicFormula("constant", load_sensitivity=True, reference_load=7.0),
     np.array([20.0, 1.5, 0.4, -0.5, -0.1, 0.2])),
    (CoulombStribeck(), np.array([30.0, 0.4, 0.7, 0.1])),
    (Brush(), np.array([15.0, 0.38])),
]  # fmt: skip


@pytest.mark.parametrize(("law", "values"), LAWS, ids=lambda x: getattr(x, "name", ""))
def test_a_table_is_the_law_to_a_hundredth_of_its_peak_and_a_thousandth_on_average(law, values):
    table = law_table(law, values, weight=WEIGHT)
    for load in (0.5, 1.7, 7.1, 20.0):
        slip = np.geomspace(1e-5, 50, 300)
        exact = law.force(slip, load, values) / load
        found = np.array([table_value(table, load, x) for x in slip])
        # Linear between rows 12 % apart in load; the peak's place moves with load.
        error = np.abs(found - exact) / exact.max()
        assert error.max() < 0.01
        assert error.mean() < 0.001


@pytest.mark.parametrize(("law", "values"), LAWS, ids=lambda x: getattr(x, "name", ""))
def test_slopes_of_columns_are_those_of_a_spline(law, values):
    table = law_table(law, values, weight=WEIGHT)
    w = table.step * np.arange(table.phi.shape[1])
    spline = CubicSpline(w, table.phi, axis=1)(w, 1)
    np.testing.assert_allclose(table.slope[:, 1:], spline[:, 1:], atol=1e-13)


TABLE = law_table(LAWS[0][0], SOURCE, weight=WEIGHT)


@pytest.mark.parametrize(("law", "values"), LAWS, ids=lambda x: getattr(x, "name", ""))
def test_all_tables_have_one_type_so_that_a_walk_is_compiled_once(law, values):
    table = law_table(law, values, weight=WEIGHT)
    scaled = scaled_table(table, grip=0.9, stiffness=1.1, fall=0.5)
    by_velocity = VelocityCoulomb(0.4).table(weight=WEIGHT)
    assert numba.typeof(table) == numba.typeof(scaled) == numba.typeof(by_velocity)


def test_a_law_proportional_to_load_has_one_row():
    assert len(law_table(LAWS[1][0], LAWS[1][1], weight=WEIGHT).log_load) == 1
    assert len(TABLE.log_load) > 1


def test_a_law_without_its_shape_at_any_load_is_refused():
    with pytest.raises(DomainError, match=r"load of 0.* 'magic-formula.*' has more than one"):
        law_table(LAWS[1][0], np.array([20.0, 1.5, 0.4, 1.5]), weight=WEIGHT)


def test_a_toe_that_slides_fast_has_the_law_s_traction_at_infinite_slip():
    law = LAWS[0][0]
    table = law_table(law, SOURCE, weight=WEIGHT)
    load = float(np.exp(table.log_load[8]))
    found = traction_secant(table, TOE, load, 10.0, 0.0) * 10.0
    assert found == pytest.approx(float(law.force(1e9, load, SOURCE)), rel=1e-3)
    # D·sin(C·pi/2), 0.63 D
    assert found / (SOURCE[2] * load) == pytest.approx(np.sin(1.564 * np.pi / 2), rel=2e-3)


def test_velocity_coulomb_is_its_formula_rolling_or_not():
    law = VelocityCoulomb(0.38, 0.001)
    table = law.table(weight=WEIGHT)
    for state in (ROLLING, TOE):
        for v in (1e-6, 1e-3, 0.02, 1.0):
            force = traction_secant(table, state, 5.0, v, 0.05) * v
            assert force == pytest.approx(5 * 0.38 * v / np.hypot(v, 0.001), rel=1e-9)


@pytest.mark.parametrize("definition", list(SlipDefinition))
def test_a_law_of_another_definition_is_evaluated_at_the_converted_slip(definition):
    law, values = LAWS[1]
    table = law_table(law, values, weight=WEIGHT, definition=definition)
    for material in (0.001, 0.02, 0.1, 0.5, 0.9):
        converted = convert_slip(material, SlipDefinition.MATERIAL, definition)
        exact = float(law.force(converted, 1.0, values))
        assert table_value(table, 1.0, material) == pytest.approx(exact, rel=1e-3)


def test_parameters_that_lose_the_laws_shape_are_refused_with_the_load():
    steep = np.array([20.0, 1.8, 0.4, 0.5])
    with pytest.raises(DomainError, match=r"at a load of .* N the curve of .* loads of a leg"):
        law_table(MagicFormula("peak"), steep, weight=WEIGHT)


@pytest.mark.parametrize(("mu", "v"), [(0.0, 0.001), (-0.3, 0.001), (0.3, 0.0)])
def test_friction_that_is_none_is_refused(mu, v):
    with pytest.raises(DomainError, match="expected both above zero"):
        VelocityCoulomb(mu, v)
