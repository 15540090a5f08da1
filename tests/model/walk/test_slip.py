# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DefinitionMismatch
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES, thesis_curve
from model.thesis.traction import slip_traction
from model.walk.path import WalkPath
from model.walk.slip import Slip
from model.walk.traction import VelocityCoulomb
from model.walk.traction_lookup import table_value

WEIGHT = 21.3
THESIS = Slip(thesis_curve(), "thesis")
COULOMB = Slip(VelocityCoulomb(0.4), "assumed")


def standing(load):
    """Return a path of one sample whose first legs press with the loads given [N]."""
    normal = np.zeros((1, 6))
    normal[0, : len(load)] = load
    zero = np.zeros((1, 6))
    return WalkPath(
        np.zeros(1), np.zeros((1, 3)), np.zeros((1, 3)), zero, normal > 0, np.zeros((1, 6, 2)),
        zero, normal, np.zeros((1, 6, 2)),
    )  # fmt: skip


def test_a_tabulated_curve_is_the_curve():
    table = THESIS.traction_table(weight=WEIGHT)
    for load, slip in ((3.0, 0.01), (7.0, 0.05), (10.0, 0.5)):
        expected = THESIS_LAW.force(slip, load, THESIS_VALUES) / load
        assert table_value(table, load, slip) == pytest.approx(expected, rel=0.02)


def test_coulomb_friction_has_no_tested_range():
    assert COULOMB.tested_loads is None
    assert COULOMB.loads_below_tested(standing([1.0])) is None
    assert COULOMB.traction_table(weight=WEIGHT).by_velocity


def test_contacts_below_the_tested_loads_are_counted():
    assert THESIS.tested_loads == (2.13, 12.75)
    assert THESIS.loads_below_tested(standing([1.0, 5.0, 2.0, 20.0])) == pytest.approx(0.5)
    assert THESIS.loads_below_tested(standing([])) == 0.0


def test_the_thesis_s_model_takes_its_own_slip_definition_only():
    other = SlipCurve(**{**vars(thesis_curve()), "definition": SlipDefinition.TRAVEL})
    with pytest.raises(DefinitionMismatch):
        slip_traction(Slip(other, "real"), weight=WEIGHT)
    slip_traction(THESIS, weight=WEIGHT)
    slip_traction(COULOMB, weight=WEIGHT)
