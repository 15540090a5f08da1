# SPDX-License-Identifier: MIT
"""What the small runs of benchmarks share."""

import pytest


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
def one_walk(shared, tmp_path, monkeypatch) -> str:
    """Let the reference data have one walk of the engine; return its name."""
    from benchmarks.accuracy import engine_walks

    name = "tripod_s1.10_left_mu0.38_tc2"
    place = tmp_path / "shared" / "virtual-world" / "walks"
    place.mkdir(parents=True)
    for file in (shared / "virtual-world" / "walks").glob(f"{name}.*"):
        (place / file.name).symlink_to(file)
    monkeypatch.setattr(engine_walks, "SHARED", tmp_path / "shared")
    return name
