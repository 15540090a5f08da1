# SPDX-License-Identifier: MIT
"""What the small runs of benchmarks share."""

from pathlib import Path

import pytest

SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "material"
law = { name = "coulomb-stribeck", stribeck = false }
[parameters]
slip_stiffness = { mean = 20.0 }
friction = { mean = 0.38 }
[covariance]
matrix = [[0.04, 0.0], [0.0, 0.0001]]
[tested]
normal_force = [2.0, 13.0]
slip_ratio = [0.0, 1.0]
[verdict]
headline = "fine"
trustworthy = true
"""


@pytest.fixture
def rows(capsys):
    """Return the cells of the rows printed since the last call, heads and rules left out."""

    def read():
        lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("|")]
        rules = {n for n, line in enumerate(lines) if set(line) <= set("|-: ")}
        kept = [line for n, line in enumerate(lines) if not {n, n + 1} & rules]
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in kept]

    return read


@pytest.fixture
def calibration(tmp_path) -> Path:
    """Write the folder of a calibration."""
    folder = tmp_path / "calibration"
    folder.mkdir()
    (folder / "slip.toml").write_text(SLIP_TOML)
    return folder


@pytest.fixture
def one_walk(shared, tmp_path, monkeypatch) -> str:
    """Let the reference data have one walk of the engine; return its name."""
    from benchmarks.accuracy import engine_walks, lab_walks

    name = "tripod_s1.10_left_mu0.38_tc2"
    place = tmp_path / "shared" / "virtual-world" / "walks"
    place.mkdir(parents=True)
    for file in (shared / "virtual-world" / "walks").glob(f"{name}.*"):
        (place / file.name).symlink_to(file)
    for module in (engine_walks, lab_walks):
        monkeypatch.setattr(module, "SHARED", tmp_path / "shared")
    return name
