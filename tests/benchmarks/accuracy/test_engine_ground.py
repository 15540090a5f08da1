# SPDX-License-Identifier: MIT
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.accuracy import engine_ground
from benchmarks.accuracy.engine_ground import (
    ALLOWED,
    CORRELATION,
    GRID,
    ROUGHNESS,
    rough,
    rough_heights,
    slopes,
    walk_by_model,
    write_ground,
)
from benchmarks.accuracy.engine_ground import (
    engine_ground as ground_of,
)
from benchmarks.accuracy.rigid_engine.agreement import agreement, motion_of
from benchmarks.accuracy.rigid_engine.arcs import height_at
from benchmarks.accuracy.rigid_engine.walking import walk
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot


def test_rough_ground_has_the_spread_and_correlation_asked_for():
    z = rough_heights(1)
    assert z.std() == pytest.approx(ROUGHNESS)
    apart = round(CORRELATION / GRID)
    correlation = (z * np.roll(z, apart, axis=0)).mean() / z.var()
    assert correlation == pytest.approx(np.exp(-0.5), abs=0.08)


def test_the_file_and_the_engine_have_the_same_ground(tmp_path):
    for case in [*slopes(), *rough(1)]:
        folder = tmp_path / f"{case.kind} {case.name}"
        written = tomllib.loads(write_ground(case, folder).read_text())
        heights, _ = ground_of(case)
        slope = np.tan(np.radians(written.get("slope_deg", [0, 0])))
        assert (heights.rise_x, heights.rise_y) == pytest.approx(tuple(slope))
        if "heights" in written:
            seen_from_above = np.loadtxt(folder / written["heights"]["file"], delimiter=",")
            x, y = written["heights"]["origin"]
            z = seen_from_above[::-1].T
            assert height_at(heights, x + 3 * GRID, y + 5 * GRID) == pytest.approx(z[3, 5])


@pytest.mark.long
def test_a_walk_on_a_slope_is_the_engine_s(rows, monkeypatch):
    monkeypatch.setattr(engine_ground, "DURATION", 3.0)
    monkeypatch.setattr(engine_ground, "slopes", lambda: slopes()[:1])
    engine_ground.main(["--only", "slope"])
    ((kind, _, _, path, contacts),) = rows()
    assert kind == "slope"
    assert float(path.split()[0]) < 2.0
    assert float(contacts.split()[0]) > 95.0


CASES = {f"{case.kind} {case.name}": case for case in [*slopes(), *rough(2)]}
FAULTS = {
    "up is down": ("slope up 5°, turning left", lambda case: replace(case, slope=(-5.0, 0.0))),
    "x is y": ("slope up 5°, turning left", lambda case: replace(case, slope=(0.0, 5.0))),
    "map transposed": ("rough seed 1", np.transpose),
    "map upside down": ("rough seed 1", np.flipud),
    "map a cell aside": ("rough seed 1", lambda heights: np.roll(heights, 1, axis=1)),
}


@pytest.fixture(scope="module")
def engine_walks():
    """Walks by the engine on the grounds of faults: leg angles over time, and the motion."""
    found = {}
    for name in {name for name, _ in FAULTS.values()}:
        legs = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
        t = np.arange(0.0, 6.001, 0.01)
        theta = legs.angles(t)
        heights, friction = ground_of(CASES[name])
        found[name] = t, theta, motion_of(walk(Robot(), t, theta, friction, heights=heights))
    return found


@pytest.mark.long
@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_ground_is_seen_and_the_right_one_passes(fault, engine_walks, tmp_path):
    name, change = FAULTS[fault]
    t, theta, truth = engine_walks[name]
    case = CASES[name]
    right = write_ground(case, tmp_path / "right")
    if case.seed is None:
        wrong = write_ground(change(case), tmp_path / "wrong")
    else:
        wrong = write_ground(case, tmp_path / "wrong")
        file = wrong.with_name("heights.csv")
        np.savetxt(file, change(np.loadtxt(file, delimiter=",")), fmt="%.17g", delimiter=",")
    errors = [agreement(walk_by_model(each, t, theta), truth).path for each in (right, wrong)]
    assert errors[0] < ALLOWED[case.kind] < errors[1], errors
