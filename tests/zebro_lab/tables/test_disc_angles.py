# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from support.rig_tables import RADII, columns, speeds, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError


def with_angles(**changes):
    table = speeds()
    return table.assign(
        angle_leg=np.cumsum(table["omega_leg"]) * 0.004,
        angle_ground=np.cumsum(table["omega_ground"]) * 0.004,
        **changes,
    )


def read(folder, table, text=RADII):
    columns(folder, text)
    write(folder, table)
    return read_rig_data([folder])


def test_angles_are_read_in_radians_with_the_radii(tmp_path):
    table = with_angles()
    angles = read(tmp_path, table).samples.angles
    np.testing.assert_allclose(angles.leg, table["angle_leg"])
    np.testing.assert_allclose(angles.ground, table["angle_ground"])
    assert (angles.radius_leg, angles.radius_ground) == (0.035, 0.12)


def test_degrees_that_are_stated_are_converted_and_may_be_wrapped_or_reversed(tmp_path):
    table = with_angles()
    table["angle_leg"] = np.degrees(-table["angle_leg"]) % 360
    text = RADII + '[columns.angle_leg]\nunit = "deg"\n'
    angles = read(tmp_path, table, text).samples.angles
    np.testing.assert_allclose(np.cos(angles.leg), np.cos(with_angles()["angle_leg"]))


@pytest.mark.parametrize("text", [RADII, RADII + '[columns.angle_leg]\nunit = "rad"\n'])
@pytest.mark.parametrize("wrapped", [False, True])
def test_degrees_that_pass_for_radians_are_improbable(tmp_path, text, wrapped):
    table = with_angles()
    table["angle_leg"] = np.degrees(table["angle_leg"])
    if wrapped:
        table["angle_leg"] %= 360
    with pytest.raises(DataError, match=r"angle_leg.*57\.3 times what its speed") as error:
        read(tmp_path, table, text)
    assert "unit of the angle" in str(error.value)


def test_an_angle_that_some_tables_lack_is_named_and_not_used(tmp_path):
    columns(tmp_path, RADII)
    write(tmp_path, with_angles(), "a.csv")
    table = with_angles(traction_force=1.01 * speeds()["traction_force"])
    write(tmp_path, table.drop(columns="angle_ground"), "b.csv")
    data = read_rig_data([tmp_path])
    assert data.samples.angles.ground is None
    assert len(data.samples.angles.leg) == len(data.samples)
    assert any("angle of the ground disc is not used" in note for note in data.notes)


def test_trials_have_no_angle(tmp_path):
    data = read(tmp_path, with_angles(), RADII + "[runs]\neach_row = true\n")
    assert data.samples.angles is None
    assert any("angles of the discs are not used" in note for note in data.notes)


def test_an_angle_that_stands_still_is_not_used_and_said(tmp_path):
    data = read(tmp_path, with_angles().assign(angle_ground=0.0))
    assert data.samples.angles.ground is None
    assert "angle_ground is not used: it does not change" in data.notes
