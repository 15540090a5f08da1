# SPDX-License-Identifier: MIT
"""Slip of a rig table: given with its definition, or from the disc speeds."""

from pathlib import Path

import numpy as np
import pytest

from model.slip.definition import SlipDefinition, convert_slip, slip_per_radius_error
from support.bounded_reading import refusal
from support.rig_tables import RADII, N, columns, given_slip, speeds, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError


def test_given_slip_keeps_its_definition(tmp_path):
    data = read_rig_data([write(tmp_path, given_slip("travel"))])
    assert data.samples.definition == "travel"
    assert data.notes[0] == "slip as given in 'slip_ratio', definition travel"


def test_slip_given_without_definition_yields_to_speeds(tmp_path):
    columns(tmp_path, RADII)
    data = read_rig_data([write(tmp_path, speeds().assign(slip_ratio=0.9))])
    assert data.samples.slip.max() == pytest.approx(0.5)
    assert "'slip_ratio' is not used, because its definition is not stated" in data.notes[0]


def test_slip_mapped_with_definition_wins_over_speeds(tmp_path):
    columns(tmp_path, "columns.slip_ratio = { name = 'SL', definition = 'travel' }\n" + RADII)
    table = speeds().assign(SL=np.linspace(0, 0.1, N))
    data = read_rig_data([write(tmp_path, table)])
    assert data.samples.slip.max() == pytest.approx(0.1)
    assert "columns of disc speeds are not used" in data.notes[0]


@pytest.mark.parametrize("stated", SlipDefinition)
@pytest.mark.parametrize("true", SlipDefinition)
def test_a_definition_that_the_speeds_contradict_is_refused(tmp_path, true, stated):
    table, rng = speeds(), np.random.default_rng(1)
    ratio = convert_slip(np.linspace(0.0, 0.5, N), "material", true)
    ratio += 0.01 * slip_per_radius_error(ratio, true) + rng.normal(0.0, 1e-3, N)
    columns(tmp_path, f"columns.slip_ratio.definition = '{stated}'\n" + RADII)
    path = write(tmp_path, table.assign(slip_ratio=ratio))
    if {true, stated} in ({stated}, {SlipDefinition.MATERIAL, SlipDefinition.LARGER}):
        notes = read_rig_data([path]).notes  # material and larger are equal where the leg is faster
        assert f"definition {stated}; the columns of disc speeds are not used" in notes[0]
        return
    with pytest.raises(DataError, match=rf"stated as '{stated}', .* state definition = \"") as told:
        read_rig_data([path])
    same = ("material", "larger") if true in ("material", "larger") else (true,)
    assert any(f'definition = "{each}"' in str(told.value) for each in same)


def test_slip_comes_from_the_speeds_of_the_surfaces_in_their_own_unit(tmp_path):
    table = speeds()
    surfaces = {
        "Ball Speed (mm/s)": 35 * table["omega_leg"],
        "v (m/s)": 0.12 * table["omega_ground"],
    }
    path = write(tmp_path, table.drop(columns=["omega_leg", "omega_ground"]).assign(**surfaces))
    mapped = "[columns]\nspeed_leg = 'Ball Speed (mm/s)'\nspeed_ground = 'v (m/s)'\n"
    columns(tmp_path, mapped)
    data = read_rig_data([path])
    np.testing.assert_allclose(data.samples.slip, np.linspace(0, 0.5, N), atol=1e-12)
    assert data.notes[0] == "slip computed from surface speeds, definition material"
    columns(tmp_path, mapped.replace("speed_leg", "omega_leg"))
    with pytest.raises(DataError, match="map the speed of a surface as speed_leg or speed_ground"):
        read_rig_data([path])


def test_one_speed_may_be_of_a_surface_and_the_other_angular(tmp_path):
    table = speeds()
    road = 0.12 * table["omega_ground"]
    path = write(tmp_path, table.drop(columns="omega_ground").assign(speed_ground=road))
    columns(tmp_path, "constants.radius_leg = '35 mm'")
    slip = read_rig_data([path]).samples.slip
    np.testing.assert_allclose(slip, np.linspace(0, 0.5, N), atol=1e-12)


def test_measured_slip_may_pass_its_limit_by_noise(tmp_path):
    table = given_slip("material").assign(slip_ratio=np.linspace(0, 1.02, N))
    assert read_rig_data([write(tmp_path, table)]).samples.slip.max() == pytest.approx(1.02)


def test_definition_stated_differently_in_map_and_file_is_refused(tmp_path):
    columns(tmp_path, "columns.slip_ratio.definition = 'travel'")
    path = write(tmp_path, given_slip("material"))
    with pytest.raises(
        DataError, match="slip definition is 'material' in this column and 'travel' in"
    ):
        read_rig_data([path])


def refused_as_travel(folder: Path, slip: float) -> tuple[Path, str]:
    """Write a slip ratio into row 8; return the file and the error of converting it."""
    table = given_slip("material")
    table.loc[7, "slip_ratio"] = slip
    path = write(folder, table)
    return path, refusal(lambda file: read_rig_data([file], slip_definition="travel"), path)


def test_slip_outside_what_conversion_allows_names_file_and_row(tmp_path):
    path, message = refused_as_travel(tmp_path, 1.05)
    assert message.startswith(f"{path}, column 'slip_ratio', row 8 (line 9): the slip ratio 1.05 ")


def test_slip_infinite_in_the_asked_definition_names_the_row(tmp_path):
    _, message = refused_as_travel(tmp_path, 1.0)
    assert (
        "row 8 (line 9): the 'material' slip ratio 1 is infinite in the definition 'travel'"
        in message
    )
