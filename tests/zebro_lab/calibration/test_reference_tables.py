# SPDX-License-Identifier: MIT
"""Tables of other laboratories, read through column maps that lie elsewhere."""

from pathlib import Path

import numpy as np
import pytest

from zebro_lab.calibration.rig_data import read_rig_data

pytestmark = pytest.mark.reference

TYRE = """
source = "real"
columns.t = { name = "ET", unit = "s" }
columns.slip_ratio = { name = "SL", definition = "travel" }
columns.normal_force = { name = "FZ", sign = -1 }
columns.traction_force = "FX"
runs.gap = "1 s"
"""
SAND = """
source = "real"
columns.slip_ratio = { name = "slip", definition = "larger" }
columns.normal_force = { name = "avg_Fz", sign = -1 }
columns.traction_force = { name = "avg_Fy", sign = -1 }
rows.keep = ["beta == 0", "slip > 0.05"]
runs.each_row = true
"""
SIMULATED_RIG = """
source = "sim:virtual-world"
columns.omega_leg = "omega_l"
columns.omega_ground = "omega_g"
columns.normal_force = "Fn"
columns.traction_force = "Ft"
constants = { radius_leg = "35 mm", radius_ground = "120 mm" }
runs.by = ["Fn_set", "kappa_set"]
"""


def read(tmp_path: Path, data: Path, text: str, **options):
    columns = tmp_path / "columns.toml"
    columns.write_text(text)
    return read_rig_data([data], columns=columns, **options)


def test_tyre_bench_is_14_runs_between_pauses(tmp_path, shared):
    path = shared / "realdata" / "tyre-bench" / "drivebrake_pure_slip.csv"
    data = read(tmp_path, path, TYRE)
    assert (len(data.samples), data.samples.n_runs) == (9648, 14)
    assert data.samples.definition == "travel"
    within_runs = np.diff(data.samples.run) == 0
    assert np.median(np.diff(data.samples.time)[within_runs]) == pytest.approx(0.01)
    assert (data.samples.normal_force > 300).all()


def test_sand_trials_of_the_drive_side_are_runs_of_their_own(tmp_path, shared):
    path = shared / "realdata" / "single-wheel-sand" / "smooth.csv"
    data = read(tmp_path, path, SAND)
    assert len(data.samples) == data.samples.n_runs == 12
    assert data.samples.time is None
    assert "177 of 189 rows left out; kept where beta == 0 and slip > 0.05" in data.notes


def test_simulated_rig_is_80_runs_and_its_slip_the_one_it_states(tmp_path, shared):
    import pandas as pd

    folder = shared / "virtual-world" / "rig"
    data = read(tmp_path, folder, SIMULATED_RIG)
    assert (len(data.samples), data.samples.n_runs) == (320_000, 80)
    assert data.source == "sim:virtual-world"
    stated = np.concatenate([pd.read_csv(f).kappa_inst for f in sorted(folder.glob("*.csv.gz"))])
    np.testing.assert_allclose(data.samples.slip, stated, atol=2e-5)
