# SPDX-License-Identifier: MIT
import tomllib

import numpy as np
import pytest

from benchmarks.accuracy import engine_ground
from benchmarks.accuracy.engine_ground import (
    CORRELATION,
    GRID,
    ROUGHNESS,
    rough_heights,
    slopes_and_patches,
    steps_and_roughness,
    write_ground,
)
from benchmarks.accuracy.engine_ground import (
    engine_ground as ground_of,
)
from benchmarks.accuracy.rigid_engine.arcs import height_at


def test_rough_ground_has_the_spread_and_correlation_asked_for():
    z = rough_heights(1)
    assert z.std() == pytest.approx(ROUGHNESS)
    apart = round(CORRELATION / GRID)
    correlation = (z * np.roll(z, apart, axis=0)).mean() / z.var()
    assert correlation == pytest.approx(np.exp(-0.5), abs=0.08)


def test_the_file_and_the_engine_have_the_same_ground(tmp_path):
    for case in [*slopes_and_patches(), *steps_and_roughness(1)]:
        folder = tmp_path / f"{case.kind} {case.name}"
        written = tomllib.loads(write_ground(case, folder).read_text())
        heights, friction = ground_of(case)
        slope = np.tan(np.radians(written.get("slope_deg", [0, 0])))
        assert (heights.rise_x, heights.rise_y) == pytest.approx(tuple(slope))
        assert [each["x"] for each in written.get("step", [])] == heights.edge.tolist()
        assert len(written.get("area", [])) == len(friction.areas)
        if "heights" in written:
            seen_from_above = np.loadtxt(folder / written["heights"]["file"], delimiter=",")
            x, y = written["heights"]["origin"]
            z = seen_from_above[::-1].T
            assert height_at(heights, x + 3 * GRID, y + 5 * GRID) == pytest.approx(z[3, 5])


@pytest.mark.long
def test_a_walk_on_a_slope_is_the_engine_s(rows, monkeypatch):
    monkeypatch.setattr(engine_ground, "DURATION", 3.0)
    monkeypatch.setattr(engine_ground, "slopes_and_patches", lambda: slopes_and_patches()[:1])
    engine_ground.main(["--only", "slope"])
    ((kind, _, _, path, contacts),) = rows()
    assert kind == "slope"
    assert float(path.split()[0]) < 2.0
    assert float(contacts.split()[0]) > 95.0
