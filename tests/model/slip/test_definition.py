# SPDX-License-Identifier: MIT
import math
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DefinitionMismatch, DomainError, ModelError
from model.slip import SlipDefinition, convert_slip, require_definition, slip_ratio
from model.slip.definition import slip_per_radius_error, walk_slip_from_material

PAIRS = tuple(permutations(SlipDefinition, 2))
DEFINITIONS = st.sampled_from(SlipDefinition)
SPEEDS = st.floats(1e-3, 10.0)


@given(SPEEDS, SPEEDS, DEFINITIONS, DEFINITIONS)
def test_converting_agrees_with_computing_from_speeds(v_l, v_g, source, target):
    converted = convert_slip(slip_ratio(v_l, v_g, source), source, target)
    # 1 - v_g/v_l has lost digits where the speeds are far apart; both sides share the loss.
    assert converted == pytest.approx(slip_ratio(v_l, v_g, target), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("source", "target"), PAIRS)
@given(slip=st.floats(-0.99, 0.99))
def test_conversion_there_and_back_changes_nothing(source, target, slip):
    back = convert_slip(convert_slip(slip, source, target), target, source)
    assert back == pytest.approx(slip, rel=1e-9, abs=1e-12)


@given(SPEEDS, DEFINITIONS)
def test_equal_speeds_give_zero_slip(speed, definition):
    assert slip_ratio(speed, speed, definition) == 0.0


@given(SPEEDS, SPEEDS, DEFINITIONS)
def test_slip_is_positive_exactly_when_the_leg_outruns_the_ground(v_l, v_g, definition):
    assert np.sign(slip_ratio(v_l, v_g, definition)) == np.sign(v_l - v_g)


@pytest.mark.parametrize(
    ("definition", "spinning", "locked"),
    [("material", 1.0, -math.inf), ("travel", math.inf, -1.0), ("larger", 1.0, -1.0),
     ("mean", 2.0, -2.0)],
)  # fmt: skip
def test_spinning_and_locked_legs_have_the_limits_the_definition_names(
    definition, spinning, locked
):
    assert slip_ratio(0.4, 0.0, definition) == spinning
    assert slip_ratio(0.0, 0.4, definition) == locked


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_definitions_share_their_slope_at_zero_slip(source, target):
    step = 1e-6
    assert convert_slip(step, source, target) / step == pytest.approx(1.0, abs=1e-5)


@given(DEFINITIONS, DEFINITIONS, st.booleans())
def test_the_limit_of_one_definition_is_that_of_any_other(source, target, leg_stands):
    speeds = (0.0, 0.4) if leg_stands else (0.4, 0.0)
    assert convert_slip(slip_ratio(*speeds, source), source, target) == slip_ratio(*speeds, target)


@pytest.mark.parametrize(
    ("slip", "source"),
    [(1.01, "material"), (-1.01, "travel"), (1.01, "larger"), (-1.01, "larger"), (2.01, "mean"),
     (-2.01, "mean")],
)  # fmt: skip
def test_slip_no_forward_turning_discs_can_have_is_refused(slip, source):
    target = "travel" if source != "travel" else "material"
    with pytest.raises(DomainError, match=f"{slip}.*'{source}'"):
        convert_slip([0.1, slip], source, target)


def test_not_a_number_stays_one_on_conversion():
    assert np.isnan(convert_slip([np.nan, 0.1], "material", "larger")).tolist() == [True, False]


def test_mixed_definitions_are_refused_with_both_names():
    with pytest.raises(DefinitionMismatch, match="'travel' but 'material'") as caught:
        require_definition("travel", SlipDefinition.MATERIAL)
    assert (caught.value.found, caught.value.expected) == ("travel", "material")
    assert isinstance(caught.value, ModelError)


def test_unknown_definition_is_refused():
    with pytest.raises(ValueError, match="wheel"):
        slip_ratio(0.4, 0.3, "wheel")


@given(st.floats(0.1, math.pi - 0.1), st.floats(0.05, 0.3), st.floats(1.0, 12.0))
def test_walk_slip_is_eq_4_31_of_the_same_contact(leg_angle, hip_speed, leg_rate):
    """Both slip ratios of one rolling leg, from its kinematics."""
    radius = 0.035
    phi = math.pi / 2 - leg_angle
    v_R = 2 * leg_rate * radius * math.cos(phi / 2) ** 2  # Eq. (4-32)
    v_C = hip_speed
    hip_height = radius * (1 + math.sin(leg_angle))
    material = (leg_rate * hip_height - hip_speed) / (radius * leg_rate)
    expected = (v_R - v_C) / v_C  # Eq. (4-31)
    assert walk_slip_from_material(material, leg_angle) == pytest.approx(expected, abs=1e-9)


@given(SPEEDS, SPEEDS, DEFINITIONS, st.floats(-1e-4, 1e-4))
def test_a_wrong_ratio_of_radii_shifts_slip_by_its_error_times_the_derivative(
    v_l, v_g, kind, error
):
    true = slip_ratio(v_l, v_g, kind)
    computed = slip_ratio(v_l, v_g / (1 + error), kind)
    shift = error * slip_per_radius_error(computed, kind)
    # The smaller speed decides how far the ratio goes; the larger's branch may change at equality.
    size = max(v_l / v_g, v_g / v_l)
    assert computed - shift == pytest.approx(true, abs=1e-8 * size + 1e-12)
