# SPDX-License-Identifier: MIT
"""Points of runs, sides and slip definitions of curves that coefficients are read off."""

import json

import pandas as pd
import pytest

from support.curve_tables import thesis_table, written_curve

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_runs_of_a_rig_are_points_by_load_and_said_to_be_simulated(run_command, sweep, tmp_path):
    ended = run_command("read-off", sweep, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    assert "SIMULATED: sim:rig-sweep" in ended.out
    assert "points are the means of 24 runs" in ended.out
    table = pd.read_csv(tmp_path / "out" / "read-off.csv")
    assert list(table["load_n"].round()) == [4, 12]
    assert abs(table["peak_over_load"][1] - 0.3798) < 0.02


def test_both_sides_are_read_and_one_that_gives_nothing_is_explained(run_command, tmp_path):
    whole = thesis_table((12.75,))
    whole = pd.concat([
        whole,
        whole[whole["slip_ratio"] < 0.05].assign(
            slip_ratio=lambda t: -t["slip_ratio"], traction_force=lambda t: -t["traction_force"]
        ),
    ])  # fmt: skip
    path = written_curve(tmp_path / "curve.csv", whole)
    ended = run_command("read-off", path, "--out", tmp_path / "out")
    assert ended.code == 0
    assert "12.75 N, braking: no peak within slip" in " ".join(ended.out.split())


def test_slip_is_converted_where_another_definition_is_asked_for(run_command, tmp_path):
    table = thesis_table((12.75,))
    path = written_curve(tmp_path / "curve.csv", table[table["slip_ratio"] < 0.9])
    given = ("read-off", path, "--out", tmp_path / "out", "--slip-definition", "travel", "--json")
    found = json.loads(run_command(*given).out)
    peak = 0.0066 * 12.75
    assert found["slip_definition"] == "travel"
    assert found["curves"][0]["peak_slip"] == pytest.approx(peak / (1 - peak), rel=0.08)
