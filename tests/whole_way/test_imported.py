# SPDX-License-Identifier: MIT
"""Tables of other programs go all the way: from their headers to a judged prediction on a page."""

import json

import pandas as pd
import pytest

from support.bundled_walk import WALK
from support.other_labs import RIG_COLUMNS, write_rig_table, write_walk_tables
from support.quick_fits import fit_quickly

FEW_STEPS = ("--law", "coulomb-stribeck", "--max-steps", 100)


@pytest.mark.usefixtures("coarse_pictures")
def test_tables_of_others_end_in_a_judged_prediction_on_one_page(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fit_quickly(monkeypatch)
    bench, walk = tmp_path / "bench", tmp_path / "motion-capture"
    for folder in (bench, walk):
        folder.mkdir()
    command("init", write_rig_table(bench), "--kind", "rig")
    (bench / "columns.toml").write_text(RIG_COLUMNS)  # what was guessed, edited
    said = command("calibrate", bench, *FEW_STEPS, code=3)
    assert "24 runs" in said
    write_walk_tables(walk)
    command("import", "--legs", walk / "legs.tsv", "--track", walk / "capture.csv",
            "--robot", WALK / "robot.toml", "--label", "lab", "--data", "data",
            "--start", "2026-03-04T05:06:07+00:00")  # fmt: skip
    run = tmp_path / "data/20260304T050607Z_walk_lab"
    assert "lab" in command("runs", "data")
    command("plot", run)
    command("predict", run, "--slip", "calibration", "--draws", 50)
    judged = command("validate", run)
    assert "coverage of the 90% band" in judged
    errors = pd.read_csv(run / "validation/metrics.csv").set_index("model")
    assert errors.loc["prediction", "ate_of_length"] < 0.03
    assert errors.loc["prediction", "ate_m"] < errors.loc["no-slip", "ate_m"]
    command("export", run, "--to", "csv", "--out", "tables")
    said = command("report", run, "--out", "page.html")
    assert "does not belong together" not in said
    page = (tmp_path / "page.html").read_text()
    assert "not trustworthy" in page
    assert "the predicted path is" in page
    commits = {json.loads(file.read_text())["software"]["commit"]
               for file in (run / "run.json", run / "validation/manifest.json")}  # fmt: skip
    assert len(commits) == 1
