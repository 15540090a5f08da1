# SPDX-License-Identifier: MIT
"""The thesis's way from a curve to B, C, D and E, by command."""

import json

import numpy as np
import pandas as pd
import pytest

from support.curve_tables import THESIS_LOADS, thesis_table, written_curve

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_the_thesis_s_grid_of_62_points_gives_its_coefficients_at_all_four_loads(
    run_command, tmp_path
):
    path = written_curve(tmp_path / "curve.csv", thesis_table())
    ended = run_command("read-off", path, "--out", tmp_path / "out", "--json")
    assert ended.code == 0, ended.err
    found = json.loads(ended.out)
    assert not found["simulated"]
    assert [each["load_n"] for each in found["curves"]] == pytest.approx(THESIS_LOADS)
    for each in found["curves"]:
        assert (each["B"], each["C"]) == (pytest.approx(34.34), pytest.approx(1.564))
        assert each["peak_over_load"] == pytest.approx(0.3798)
        assert each["peak_slip"] == pytest.approx(0.0066 * each["load_n"])
    table = pd.read_csv(tmp_path / "out" / "read-off.csv")
    np.testing.assert_allclose(table["E"], [each["E"] for each in found["curves"]], rtol=1e-4)
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert set(manifest["inputs"]) == {str(path)}


def test_runs_of_a_rig_are_points_by_load_and_said_to_be_simulated(run_command, sweep, tmp_path):
    ended = run_command("read-off", sweep, "--out", tmp_path / "out")
    assert ended.code == 0, ended.err
    assert "SIMULATED data, source 'sim:rig-sweep'" in ended.out
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


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (thesis_table((12.75,)).head(4), "no peak within"),
    ],
)  # fmt: skip
def test_a_table_without_a_curve_at_a_load_is_one_line_and_writes_nothing(
    run_command, tmp_path, table, message
):
    path = written_curve(tmp_path / "curve.csv", table)
    ended = run_command("read-off", path, "--out", tmp_path / "out")
    assert ended.code == 1
    assert message in ended.err
    assert not (tmp_path / "out").exists()
