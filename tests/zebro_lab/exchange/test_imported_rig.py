# SPDX-License-Identifier: MIT
"""The table of a slip rig becomes a run folder for each run in it."""

from datetime import UTC, datetime

import numpy as np
import pandas as pd
import pytest

from support.imported_files import taken
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError
from zebro_lab.runs.manifest import read_manifest


def test_a_rigs_table_is_calibrated_as_the_table_itself(sweep, tmp_path):
    table = sweep / "sweep.csv"
    imported = taken(tmp_path, rig=table, material="POM", start=datetime(2026, 1, 1, tzinfo=UTC))
    assert len(imported.folders) == 24
    ours, theirs = read_rig_data([tmp_path / "data"]), read_rig_data([table])
    order = np.argsort([ours.samples.run_names.index(f.name) for f in imported.folders])
    assert np.array_equal(order, np.arange(24))  # folders are named by when each run began
    for column in ("slip", "normal_force", "traction_force", "run"):
        ours_column, theirs_column = getattr(ours.samples, column), getattr(theirs.samples, column)
        np.testing.assert_allclose(ours_column, theirs_column, rtol=1e-12)
    assert ours.source == theirs.source == "sim:rig-sweep"
    assert ours.load_cell == theirs.load_cell == {"zero_stability": 0.1}
    assert read_manifest(imported.folders[0]).material == "POM"


STATED = """
source = "sim:rig-sweep"
[runs]
by = ["run"]
[load_cell]
zero_stability = 0.1
[rig_errors]
radius = "0.2 mm"
rolling_resistance = 0.03
[priors]
friction = "0.40 ± 0.05"
shape = "~ uniform(1.2, 1.9)"
"""


def test_angles_lateral_force_and_what_is_stated_come_along(sweep, tmp_path):
    table = pd.read_csv(sweep / "sweep.csv")
    step = table.groupby("run").t.diff().fillna(0.0)
    for disc in ("leg", "ground"):
        turned = (table[f"omega_{disc}"] * step).groupby(table.run).cumsum()
        table[f"angle_{disc}"] = turned % (2 * np.pi)
    table["lateral_force"] = np.random.default_rng(2).normal(0.1, 0.05, len(table))
    table.to_csv(tmp_path / "own.csv", index=False)
    (tmp_path / "columns.toml").write_text(STATED, encoding="utf-8")
    taken(tmp_path, rig=tmp_path / "own.csv", start=datetime(2026, 1, 1, tzinfo=UTC))
    ours, theirs = read_rig_data([tmp_path / "data"]), read_rig_data([tmp_path / "own.csv"])
    for disc in ("leg", "ground"):
        np.testing.assert_allclose(
            getattr(ours.samples.angles, disc), getattr(theirs.samples.angles, disc), rtol=1e-12
        )
    assert ours.lateral == theirs.lateral
    assert ours.rig_errors == theirs.rig_errors
    assert set(ours.priors) == set(theirs.priors)
    assert len(ours.priors) == 2
    assert ours.load_cell == theirs.load_cell


def test_a_rig_without_speeds_or_with_trials_is_left_to_the_calibration(sweep, tmp_path):
    table = pd.read_csv(sweep / "sweep.csv")
    given = table.drop(columns=["omega_leg"]).assign(slip_ratio=0.1)
    given.to_csv(tmp_path / "slip.csv", index=False)
    with pytest.raises(DataError, match="give this table to calibrate-slip"):
        taken(tmp_path, rig=tmp_path / "slip.csv")
    table.to_csv(tmp_path / "trials.csv", index=False)
    (tmp_path / "columns.toml").write_text("[runs]\neach_row = true")
    with pytest.raises(DataError, match="is the mean of a trial"):
        taken(tmp_path, rig=tmp_path / "trials.csv")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"traction_force": lambda d: 1000 * d.traction_force}, r"times the normal force, .*unit"),
        ({"traction_force": lambda d: d.traction_force.where(d.index != 40, -9999)},
         r"row 41 .*found -9999 N, more than 10 times the largest normal force.*a missing value"),
        ({"omega_leg": lambda d: d.omega_ground, "omega_ground": lambda d: d.omega_leg},
         "are the speeds exchanged"),
        ({"t": lambda d: 1e5 * d.t}, r"samples are \d+ s apart.*\[columns.t\] unit = \"ms\""),
    ],
)  # fmt: skip
def test_what_no_rig_measures_is_not_imported(sweep, tmp_path, changes, message):
    table = pd.read_csv(sweep / "sweep.csv").assign(radius_leg=0.035, radius_ground=0.12)
    table.assign(**changes).to_csv(tmp_path / "a.csv", index=False)
    with pytest.raises(DataError, match=message):
        taken(tmp_path, rig=tmp_path / "a.csv")
    assert not (tmp_path / "data").exists()


def test_unloaded_rows_are_imported_too(sweep, tmp_path):
    table = pd.read_csv(sweep / "sweep.csv").assign(radius_leg=0.035, radius_ground=0.12)
    table.loc[:9, ["normal_force", "traction_force", "omega_leg"]] = 0.0
    table.to_csv(tmp_path / "a.csv", index=False)
    assert len(taken(tmp_path, rig=tmp_path / "a.csv").folders) == 24
