# SPDX-License-Identifier: MIT
"""What a `columns.toml` states of a rig, as a fit takes it."""

from pathlib import Path

import pytest

from model.slip.definition import SlipDefinition
from model.slip.rig_errors import UNKNOWN_RATIO, UNKNOWN_SCATTER, radius_ratio_sd
from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.rig_columns import RigErrorsStated, parse_definition

RADII = {"radius_leg": 0.035, "radius_ground": 0.12}


def test_errors_of_the_radii_are_those_of_their_ratio():
    found = RigErrorsStated(radius=2e-4).resolved(RADII)
    assert found.radius_ratio == pytest.approx(radius_ratio_sd(*RADII.values(), 2e-4))
    assert RigErrorsStated(radius_ratio=0.01).resolved(RADII).radius_ratio == 0.01


def test_without_radii_the_ratio_is_as_good_as_unknown():
    found = RigErrorsStated().resolved({"radius_leg": 0.035})
    assert (found.radius_ratio, found.slip_scatter) == (UNKNOWN_RATIO, UNKNOWN_SCATTER)


def test_a_definition_is_parsed_or_the_nearest_is_named():
    assert parse_definition("material", file=None, key="x") is SlipDefinition.MATERIAL
    with pytest.raises(SettingsError, match=r"a\.toml, x: unknown slip definition 'travl'.*travel"):
        parse_definition("travl", file=Path("a.toml"), key="x")
