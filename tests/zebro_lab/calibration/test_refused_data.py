# SPDX-License-Identifier: MIT
"""What `calibrate-slip` cannot use is told in one line, and nothing is written."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from support.calibrate_processes import COMMAND, calibrate_slip, names
from zebro_lab.main import slip_app as app
from zebro_lab.terminal.ending import run as run_app


@pytest.fixture
def refusal(monkeypatch, capsys):
    """Return a runner of the command in this process: its one line, having checked its ending."""

    def run(*arguments: object, out: Path) -> str:
        monkeypatch.setattr(sys, "argv", [COMMAND, *map(str, arguments), "--out", str(out)])
        with pytest.raises(SystemExit) as ended:
            run_app(app)
        streams = capsys.readouterr()
        assert ended.value.code == 1
        assert "parameters" not in streams.out  # what was read may be told
        assert streams.err.startswith("error: ")
        assert streams.err.endswith("\n")
        assert streams.err.count("\n") == 1
        return streams.err

    return run


def faulty(sweep: Path, folder: Path, fault: str) -> None:
    """Write the sweep with a fault into a folder."""
    (folder / "columns.toml").write_text((sweep / "columns.toml").read_text())
    table = pd.read_csv(sweep / "sweep.csv").head(600)
    file = folder / "rig.csv"
    match fault:
        case "missing column":
            table = table.drop(columns="normal_force")
        case "unknown unit":
            with (folder / "columns.toml").open("a") as columns:
                columns.write('\n[columns.normal_force]\nunit = "Newtom"\n')
        case "not a number":
            table.loc[40, "traction_force"] = np.nan
        case "infinite":
            table.loc[40, "traction_force"] = np.inf
        case "negative load":
            table.loc[40, "normal_force"] = -1.0
        case "constant slip":
            table = table.assign(omega_leg=12.0, omega_ground=3.0)
        case "mixed definitions":
            ratios = table.drop(columns=["omega_leg", "omega_ground", "radius_leg"])
            ratios.assign(slip_ratio=0.1, slip_definition="travel").to_csv(
                folder / "other.csv", index=False
            )
        case "repeated time":
            table.loc[40, "t"] = table.loc[39, "t"]
        case "three samples":
            table = table.head(3)
    table.to_csv(file, index=False)
    match fault:
        case "empty folder":
            file.unlink()
        case "truncated parquet":
            file.unlink()
            table.to_parquet(folder / "rig.parquet")
            content = (folder / "rig.parquet").read_bytes()
            (folder / "rig.parquet").write_bytes(content[: len(content) // 2])
        case "binary file":
            file.write_bytes(bytes(range(256)) * 8)


FAULTS = {
    "missing column": "column 'normal_force': is missing",
    "unknown unit": "unknown unit 'Newtom'",
    "not a number": "column 'traction_force', row 41 (line 42): is empty; expected finite",
    "infinite": "column 'traction_force', row 41 (line 42): is infinite; expected finite",
    "negative load": "column 'normal_force', row 41 (line 42): the normal force is -1 N",
    "constant slip": "a curve needs several set-points",
    "mixed definitions": "'travel'",
    "repeated time": "column 't', row 41 (line 42): time",
    "three samples": "3 samples in all, expected at least 20",
    "empty folder": "holds no data",
    "truncated parquet": "rig.parquet: is not a complete Parquet file",
    "binary file": "rig.csv: is not text but a binary file",
}


@pytest.mark.parametrize("fault", FAULTS)
def test_bad_input_is_one_line_and_leaves_nothing(sweep, tmp_path, refusal, fault):
    data, out = tmp_path / "data", tmp_path / "out"
    data.mkdir()
    faulty(sweep, data, fault)
    line = refusal(data, out=out)
    assert FAULTS[fault] in line
    assert str(data) in line
    assert names(tmp_path) == {"data"}


@pytest.mark.parametrize(
    "fault",
    [
        "not a number",
        pytest.param("truncated parquet", marks=pytest.mark.long),
        pytest.param("empty folder", marks=pytest.mark.long),
    ],
)
def test_bad_input_ends_the_process_with_1_and_no_traceback(sweep, tmp_path, fault):
    data = tmp_path / "data"
    data.mkdir()
    faulty(sweep, data, fault)
    process = calibrate_slip(data, "--out", tmp_path / "out")
    assert (process.returncode, process.stdout) == (1, "")
    assert process.stderr.startswith("error: ")
    assert process.stderr.count("\n") == 1
    assert FAULTS[fault] in process.stderr
    assert names(tmp_path) == {"data"}


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (("--columns", "absent.toml"), "absent.toml"),
        (("--resume",), "checkpoint.npz: no stopped fit to resume; run without --resume"),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_option_that_cannot_be_followed_is_one_line(sweep, tmp_path, refusal, options, problem):
    assert problem in refusal(sweep, *options, out=tmp_path / "out")
    assert names(tmp_path) == set()


def test_damaged_checkpoint_is_one_line_and_is_kept(sweep, tmp_path, refusal):
    (tmp_path / "checkpoint.npz").write_bytes(b"PK\x03\x04 no archive")
    line = refusal(sweep, "--resume", out=tmp_path)
    assert "checkpoint.npz: is not a checkpoint of zebro-lab" in line
    assert "delete it and run without --resume" in line
    assert names(tmp_path) == {"checkpoint.npz"}
