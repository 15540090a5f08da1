# SPDX-License-Identifier: MIT
"""An exported run is what its readers read, and says where it comes from."""

import sys

import numpy as np
import pytest

from support.watchers import Onlooker
from zebro_lab.exchange.export_stage import FORMATS, export_run
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.stage import record
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.tables.table_files import read_table_file


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Return a run folder of a simulated robot and rig."""
    data = tmp_path_factory.mktemp("data")
    return record(RecordRequest("x", data, zebro="sim", rig="sim", duration=2.0), Onlooker()).folder


@pytest.mark.parametrize("form", FORMATS)
def test_tables_hold_what_stages_read(recorded, tmp_path, form):
    files, _ = export_run(recorded, to=form, out=tmp_path / "out")
    names = {file.name.partition(".")[0] for file in files if file.suffix != ".toml"}
    assert names == {"legs", "slip_rig", "legs_raw", "drives_raw", "load_cell_raw"}
    rig = read_table_file(tmp_path / "out" / f"slip_rig.{form}")
    table = read_slip_rig_run(recorded).table
    for name, values in vars(table).items():
        np.testing.assert_allclose(rig.numbers(name), values, rtol=1e-12)
    assert set(rig.numbers("radius_leg")) == {0.035}
    legs = read_leg_log(tmp_path / "out" / f"legs.{form}")
    assert legs.source == "sim:zebro+rig"
    theta = read_leg_log(recorded).reference.theta
    np.testing.assert_allclose(legs.reference.theta, theta, atol=1e-9)


def test_without_pyarrow_the_line_says_how_to_get_it(recorded, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(SettingsError, match=r"--to: .*pip install 'zebro-lab\[parquet\]'"):
        export_run(recorded, to="parquet", out=tmp_path / "parquet")
    assert not (tmp_path / "parquet").exists()


def test_what_is_there_is_not_written_over(recorded, tmp_path):
    with pytest.raises(AlreadyExists, match="another folder with --out"):
        export_run(recorded, to="csv", out=tmp_path)
