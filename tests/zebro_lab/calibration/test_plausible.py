# SPDX-License-Identifier: MIT
"""Rig data with exchanged columns or other units are refused before the fit, and say which."""

import numpy as np
import pandas as pd
import pytest

from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError

COLUMNS = '[constants]\nradius_leg = {leg}\nradius_ground = "120 mm"\n'
SLIP = np.linspace(0.02, 0.9, 60)


@pytest.fixture
def table(tmp_path):
    """Return a function that writes a sweep, changed, with a column map, and returns its path."""

    def write(*, leg='"35 mm"', more="", **changed):
        omega = np.full(60, 12.0)
        frame = pd.DataFrame({
            "omega_leg": omega,
            "omega_ground": omega * (35 / 120) * (1 - SLIP),
            "normal_force": 8.0 + 0.1 * np.sin(SLIP),
            "traction_force": 8.0 * 0.45 * np.tanh(10 * SLIP),
        })  # fmt: skip
        (tmp_path / "columns.toml").write_text(COLUMNS.format(leg=leg) + more)
        frame.assign(**changed).to_csv(tmp_path / "sweep.csv", index=False)
        return tmp_path / "sweep.csv"

    return write


def test_a_plausible_sweep_is_read_without_a_doubt(table):
    assert not any("IMPROBABLE" in note for note in read_rig_data([table()]).notes)
    fast = table(omega_ground=lambda d: d.omega_leg * 35 / 120 * np.linspace(0.05, 0.2, 60))
    assert not any("IMPROBABLE" in note for note in read_rig_data([fast]).notes)


def test_exchanged_radii_are_asked_about(table):
    exchanged = table(omega_ground=lambda d: d.omega_leg * 120 / 35 * (1 - SLIP))
    with pytest.raises(DataError, match=r"beyond 1\.5 in"):
        read_rig_data([exchanged])
    file = table(leg='"120 mm"')
    columns = file.with_name("columns.toml")
    columns.write_text(columns.read_text().replace('ground = "120 mm"', 'ground = "35 mm"'))
    (note,) = (note for note in read_rig_data([file]).notes if "IMPROBABLE" in note)
    assert "slip ratios of sweep.csv are 0.92 or more; with the radii of the discs exch" in note
    assert note.endswith(f"are radius_leg and radius_ground exchanged in {columns}?")


def test_a_refusal_names_the_column_map_that_was_read_from_above(table):
    sweep = table(more="[columns.traction_force]\nsign = -1\n")
    below = sweep.parent / "deep" / "day"
    below.mkdir(parents=True)
    moved = sweep.rename(below / sweep.name)
    columns = sweep.with_name("columns.toml")
    with pytest.raises(DataError, match="opposes the slip") as raised:
        read_rig_data([moved])
    assert f"[columns.traction_force] sign = 1 in {columns}, or" in str(raised.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"leg": "35"}, r'radius_leg.*the radius is 35 m; expected 3 m or less.*"35 mm"'),
        (
            {"omega_leg": lambda d: d.omega_ground, "omega_ground": 12.0},
            r"omega_leg.*beyond 1\.5 in 100% of the rows.*are the speeds exchanged",
        ),
        (
            {"omega_ground": lambda d: -d.omega_ground},
            r"omega_leg.*opposite directions in 100% of the rows; set sign = -1",
        ),
        (
            {"normal_force": lambda d: 102 * d.normal_force},
            r'normal_force.*is 0\.0044 times the normal force.*\[columns.normal_force\] unit = "N"',
        ),
        (
            {"traction_force": lambda d: -d.traction_force},
            r"traction_force.*opposes the slip in 100% of .*traction_force\] sign = -1",
        ),
        (
            {"traction_force": lambda d: 1000 * d.traction_force},
            r"normal_force.*the traction force is 4.+ times the normal force",
        ),
    ],
)
def test_what_no_rig_measures_is_refused(table, changes, message):
    with pytest.raises(DataError, match=message):
        read_rig_data([table(**changes)])


def test_improbable_forces_of_stated_units_are_told_of(table):
    stated = '[columns]\nnormal_force = {name = "normal_force", unit = "N"}\n'
    stated += 'traction_force = {name = "traction_force", unit = "N"}\n'
    data = read_rig_data([table(more=stated, traction_force=lambda d: 0.01 * d.traction_force)])
    assert any(note.startswith("IMPROBABLE FORCES: the traction") for note in data.notes)


def test_a_header_that_is_mapped_states_no_unit(table):
    mapped = '[columns]\nnormal_force = "normal_force"\ntraction_force = "traction_force"\n'
    with pytest.raises(DataError, match=r"\[columns.normal_force\] unit"):
        read_rig_data([table(more=mapped, traction_force=lambda d: 0.01 * d.traction_force)])


def test_hard_braking_is_plausible(table):
    turning = {"omega_ground": 12.0 * (35 / 120) * (1 + SLIP)}
    read_rig_data([table(**turning, traction_force=lambda d: -d.traction_force)])
