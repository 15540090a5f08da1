# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DefinitionMismatch
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.magic_formula import MagicFormula

VALUES = np.array([20.4, 1.56, 0.38, 0.0066])
CURVE = SlipCurve(
    law=MagicFormula(),
    values=VALUES,
    covariance=np.diag(VALUES / 100) ** 2,
    definition=SlipDefinition.MATERIAL,
    load_range=(2.0, 13.0),
    slip_range=(0.0, 1.0),
)


@given(st.floats(-1, 1), st.floats(0.1, 50))
def test_force_is_that_of_the_law_at_its_values(slip, load):
    force = CURVE.force(slip, load, definition="material")
    assert force == CURVE.law.force(slip, load, VALUES)


@pytest.mark.parametrize("definition", [SlipDefinition.TRAVEL, "larger"])
def test_slip_of_another_definition_is_refused(definition):
    with pytest.raises(DefinitionMismatch) as caught:
        CURVE.force(0.1, 5.0, definition=definition)
    assert (caught.value.found, caught.value.expected) == (str(definition), "material")
