# SPDX-License-Identifier: MIT
"""The table beside evo: all errors of own files agree."""

import pytest

from support.foreign_trajectories import drive, euroc, tum, written

pytest.importorskip("evo", reason="evo is an extra: pip install evo")
from benchmarks.accuracy import foreign_trajectories as benchmark

UNIX = 1_400_000_000.0


@pytest.fixture
def folder(tmp_path, monkeypatch):
    t, *truth = drive(40)
    _, *rough = drive(40, noise=0.02, seed=3)
    written(tmp_path / "truth.csv", euroc(UNIX + t, *truth))
    lines = tum(UNIX + t, *rough).splitlines()
    again = " ".join([lines[9].split()[0], *lines[10].split()[1:]])
    written(tmp_path / "rough.txt", "\n".join([*lines[:10], again, *lines[10:]]))
    pair = ("truth.csv", "rough.txt", (benchmark.EUROC, benchmark.TUM), 1.0, ())
    monkeypatch.setattr(benchmark, "PAIRS", (pair,))
    return tmp_path


def test_own_files_agree_although_a_stamp_is_repeated(folder, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["foreign_trajectories", str(folder)])
    benchmark.main()
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 + 2 * 8
    assert float(lines[-1].split()[2]) < 1e-5
