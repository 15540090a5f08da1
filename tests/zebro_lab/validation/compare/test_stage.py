# SPDX-License-Identifier: MIT
"""Two of a kind over each other: what differs is said, with how surely."""

import json
from pathlib import Path

import pandas as pd
import pytest

from support.compared_folders import calibration, compared, run_folder
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound, SettingsError
from zebro_lab.validation.compare.stage import compare


def test_the_folder_holds_a_table_a_picture_and_where_it_comes_from(tmp_path):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", friction=0.5)
    compared(one, other, tmp_path / "out")
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    assert manifest["kind"] == "comparison"
    assert manifest["of"] == "calibrations"
    assert manifest["source"] == "sim:rig-sweep"
    assert set(manifest["inputs"]) == {str(folder / "slip.toml") for folder in (one, other)}
    assert set(manifest["outputs"]) == {"comparison.csv", "comparison.png"}
    table = pd.read_csv(tmp_path / "out/comparison.csv")
    assert len(table) == len(manifest["quantities"])


def test_a_calibration_is_compared_with_the_thesis_s_curve_by_its_name(tmp_path):
    fitted = calibration(tmp_path / "fitted", friction=0.5)
    done = compare(fitted, Path("thesis"), out=tmp_path / "out")
    names = [each.name for each in done.comparison.quantities]
    which = names.index("peak force at 7.5 N")
    peak = done.comparison.quantities[which].quantiles(1)
    assert peak == pytest.approx((0.3798 * 7.5,) * 3, rel=1e-3)
    assert done.differences[which].clear


def test_what_cannot_be_compared_is_named(tmp_path):
    slip, run = calibration(tmp_path / "slip"), run_folder(tmp_path / "run")
    (tmp_path / "empty").mkdir()
    with pytest.raises(SettingsError, match="two of a kind"):
        compare(slip, run, out=tmp_path / "out")
    with pytest.raises(NotFound, match="is no folder with"):
        compare(slip, tmp_path / "empty", out=tmp_path / "out")
    with pytest.raises(SettingsError, match="with itself"):
        compare(slip, slip, out=tmp_path / "out")
    blind = run_folder(tmp_path / "blind", yaw=False)
    with pytest.raises(DataError, match="has no headings"):
        compare(run, blind, out=tmp_path / "out")
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken/manifest.json").write_text('{"kind": "track"}')
    with pytest.raises(AlreadyExists, match="another command"):
        compare(slip, slip, out=tmp_path / "taken")


def test_two_files_of_trajectories_are_sent_to_validate(tmp_path):
    for name in ("a.tum", "b.txt"):
        (tmp_path / name).write_text("0 0 0 0 0 0 0 1\n")
    with pytest.raises(NotFound, match=r"a\.tum .*validate REFERENCE ESTIMATE$"):
        compare(tmp_path / "a.tum", tmp_path / "b.txt", out=tmp_path / "out")
    assert not (tmp_path / "out").exists()
