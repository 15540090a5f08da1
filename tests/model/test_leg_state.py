# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest

from model.errors import DomainError
from model.leg_state import ANISOTROPY, LegState, law_in, log_spread, scaled_table
from model.slip.magic_formula import MagicFormula
from model.walk.traction import VelocityCoulomb, law_table
from model.walk.traction_lookup import table_value

TABLE = VelocityCoulomb(0.38).table(weight=21.0)


def test_scaling_a_law_scales_its_traction_and_its_stiffness_apart():
    values = (34.0, 1.56, 0.38, 0.0066)
    law = MagicFormula(curvature=0.0)
    table = law_table(law, values[: len(law.parameters)], weight=21.0)
    for grip, stiffness in ((1.0, 1.0), (0.5, 1.0), (1.0, 1.7), (1.3, 0.6)):
        scaled = scaled_table(table, grip=grip, stiffness=stiffness)
        small, large = 1e-6, 50.0
        assert table_value(scaled, 7.0, small) == pytest.approx(
            stiffness * table_value(table, 7.0, small), rel=1e-3
        )
        assert table_value(scaled, 7.0, large) == pytest.approx(
            grip * table_value(table, 7.0, large), rel=0.02
        )


def test_without_its_fall_traction_keeps_its_peak():
    table = law_table(MagicFormula(curvature=0.0), (34.0, 1.56, 0.38), weight=21.0)
    top = table.phi.max()
    kept = scaled_table(table, grip=1.0, stiffness=1.0, fall=0.0)
    half = scaled_table(table, grip=1.0, stiffness=1.0, fall=0.5)
    assert table_value(kept, 7.0, 50.0) == pytest.approx(top, rel=1e-3)
    assert kept.toe[0] == pytest.approx(top)
    lost = [top - table_value(each, 7.0, 50.0) for each in (table, half)]
    assert lost[1] == pytest.approx(lost[0] / 2, rel=1e-3)
    for slip in (1e-6, 1e-3, 0.01):  # before the peak nothing changes
        assert table_value(kept, 7.0, slip) == pytest.approx(table_value(table, 7.0, slip))


def test_friction_that_does_not_fall_has_no_fall():
    scaled = scaled_table(TABLE, grip=1.0, stiffness=1.0, fall=0.0)
    np.testing.assert_allclose(scaled.phi, TABLE.phi)


def test_parts_of_draws_are_the_draws_in_order():
    state = LegState.of_prior(5, offset_sd=0.1, rng=np.random.default_rng(1))
    parts = [state.part(slice(i, i + 2)) for i in (0, 2, 4)]
    assert [len(part) for part in parts] == [2, 2, 1]
    np.testing.assert_array_equal(np.concatenate([part.offset for part in parts]), state.offset)


def test_draws_of_lateral_traction_are_lognormal_and_change_no_other_draw():
    alike, spread = (
        LegState.of_prior(4000, offset_sd=0.01, anisotropy=factor, rng=np.random.default_rng(1))
        for factor in (1.0, 1.3)
    )
    np.testing.assert_array_equal(alike.offset, spread.offset)
    np.testing.assert_array_equal(alike.lateral_grip, 1.0)
    np.testing.assert_array_equal(alike.lateral_stiffness, 1.0)
    for each in (spread.lateral_grip, spread.lateral_stiffness):
        assert np.log(each).std() == pytest.approx(np.log(1.3), rel=0.05)
        assert np.log(each).mean() == pytest.approx(0.0, abs=0.02)
    drawn = law_in(TABLE, spread, 5)
    assert drawn.lateral_grip == spread.lateral_grip[5]
    assert drawn.lateral_stiffness == spread.lateral_stiffness[5]


def test_a_factor_of_one_is_no_spread():
    assert log_spread(1.0) == 0.0
    assert math.exp(log_spread(ANISOTROPY)) == pytest.approx(ANISOTROPY)


@pytest.mark.parametrize("factor", [0.9, -1.0, math.inf, math.nan])
def test_a_factor_below_one_or_infinite_is_an_error(factor):
    with pytest.raises(DomainError, match="anisotropy"):
        log_spread(factor)
