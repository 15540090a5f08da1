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


# What else of tables and folders is refused, and how it is named, is in `test_bad_input.py`.
PROBLEM = "column 'traction_force', row 41 (line 42): is empty; expected finite"


@pytest.fixture
def faulty(sweep, tmp_path) -> Path:
    """Return a folder with a table of the sweep in which a cell is empty."""
    data = tmp_path / "data"
    data.mkdir()
    (data / "columns.toml").write_text((sweep / "columns.toml").read_text())
    table = pd.read_csv(sweep / "sweep.csv").head(600)
    table.loc[40, "traction_force"] = np.nan
    table.to_csv(data / "rig.csv", index=False)
    return data


def test_bad_input_is_one_line_and_leaves_nothing(faulty, tmp_path, refusal):
    line = refusal(faulty, out=tmp_path / "out")
    assert PROBLEM in line
    assert str(faulty / "rig.csv") in line
    assert names(tmp_path) == {"data"}


def test_bad_input_ends_the_process_with_1_and_no_traceback(faulty, tmp_path):
    process = calibrate_slip(faulty, "--out", tmp_path / "out")
    assert (process.returncode, process.stdout) == (1, "")
    assert process.stderr.startswith("error: ")
    assert process.stderr.count("\n") == 1
    assert PROBLEM in process.stderr
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
