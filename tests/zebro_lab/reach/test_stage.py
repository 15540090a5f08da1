# SPDX-License-Identifier: MIT
"""`reach` compares two ways, and its programs walk them again and can be played to a robot."""

import csv
import json

import numpy as np
import pytest

from zebro_lab.walk.folder import read_walk

SLIP = ("--slip", "thesis", "--dt", "0.005")
QUICK = ("--cycle", "0.5")


def rows_of(folder):
    with (folder / "reach.csv").open(newline="") as text:
        return list(csv.DictReader(text))


def test_both_ways_to_each_goal_are_compared_and_walked_again_by_their_programs(
    run_command, tmp_path
):
    out, walk = tmp_path / "reach", tmp_path / "walk"
    goals = ("--goal", "0.4,-0.1", "--goal", "-0.2,0,90")
    ended = run_command("reach", *goals, *SLIP, *QUICK, "--out", out)
    assert ended.code == 0, ended.err
    assert "goal 1 (0.4, -0.1 m): " in ended.out
    assert "SIMULATED" in ended.out
    rows = rows_of(out)
    assert [(row["goal"], row["manoeuvre"]) for row in rows] == [
        (goal, way) for goal in "12" for way in ("stop-turn-walk", "curve")
    ]
    assert all(float(row["place_error_m"]) < 0.002 for row in rows)
    assert all(abs(float(row["heading_error_rad"])) < 0.01 for row in rows[2:])
    assert all(float(row["work_done_j"]) > float(row["work_taken_back_j"]) > 0 for row in rows)
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["source"] == "sim:dynamics"
    assert {"reach.csv", "reach.png", "goal1-curve.toml"} <= manifest["outputs"].keys()
    for row in rows[::3]:
        ended = run_command("walk", out / row["program"], *SLIP, "--out", walk)
        assert ended.code == 0, ended.err
        path = read_walk(walk)
        end = [*path.position[-1, :2], path.yaw[-1]]
        told = [float(row[name]) for name in ("end_x_m", "end_y_m", "end_yaw_rad")]
        np.testing.assert_allclose(end, told, rtol=1e-8, atol=1e-8)
        assert path.energy[-1, 0] == pytest.approx(float(row["work_done_j"]), rel=1e-8)
        assert path.t[-1] == pytest.approx(float(row["time_s"]))


def test_the_walk_of_a_program_is_played_to_a_robot(run_command, tmp_path):
    folder, walk, data = (tmp_path / name for name in ("reach", "walk", "data"))
    given = ("--goal", "0.1,0", *SLIP, *QUICK)
    assert run_command("reach", *given, "--out", folder).code == 0
    program = folder / "stop-turn-walk.toml"
    assert run_command("walk", program, *SLIP, "--out", walk).code == 0
    ended = run_command(
        "record", "--zebro", "sim", "--play", walk, "--label", "x", "--data", data, "--json"
    )
    assert ended.code == 0, ended.err
    document = json.loads(ended.out)
    assert document["command"] == "record"
    assert document["simulated"]
    (run,) = data.iterdir()
    kept = json.loads((run / "run.json").read_text())
    assert kept["streams"]["/legs/raw"] > 20
    (counted,) = kept["counters"].values()
    assert counted["lost"] == 0
