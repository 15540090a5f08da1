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


def test_a_table_without_a_curve_at_a_load_is_one_line_and_writes_nothing(run_command, tmp_path):
    path = written_curve(tmp_path / "curve.csv", thesis_table((12.75,)).head(4))
    ended = run_command("read-off", path, "--out", tmp_path / "out")
    assert ended.code == 1
    assert "no peak within" in ended.err
    assert not (tmp_path / "out").exists()
