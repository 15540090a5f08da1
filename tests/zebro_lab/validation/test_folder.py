# SPDX-License-Identifier: MIT
"""A validation folder holds every error with its unit, and means over walks."""

import json

import numpy as np
import pandas as pd
import pytest

from support.validated_walks import predicted, request_of, rows_of, write_walk_data
from support.watchers import Nobody
from zebro_lab.validation.folder import metrics
from zebro_lab.validation.stage import validate

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_the_folder_holds_tables_pictures_tum_files_and_a_manifest(validated, walk):
    folder = walk / "validation"
    manifest = json.loads((folder / "manifest.json").read_text())
    assert "sim:legs" in manifest["source"]
    assert len(manifest["inputs"]) == 3
    assert set(manifest["outputs"]) == {p.name for p in folder.iterdir()} - {"manifest.json"}
    metrics = pd.read_csv(folder / "metrics.csv").set_index("model")
    assert metrics.loc["prediction", "ate_m"] < metrics.loc["no-slip", "ate_m"]
    tum = np.loadtxt(next(folder.glob("*.track.tum")))
    assert tum.shape == (len(validated.runs[0].track), 8)


def test_several_walks_get_a_mean_with_an_interval(tmp_path):
    pairs = []
    for i, steering in enumerate((1.1, 1.2, 1.3)):
        folder = tmp_path / f"walk{i}"
        folder.mkdir()
        legs, track = write_walk_data(folder, steering=steering, seed=i)
        pairs.append((predicted(folder, legs, draws=0), track))
    done = validate(request_of(pairs, tmp_path / "out"), Nobody())
    assert {run.name for run in done.runs} == {"walk0", "walk1", "walk2"}
    ate = next(s for s in done.summary if (s.model, s.metric) == ("prediction", "ate_m"))
    assert ate.interval.low <= ate.interval.mean <= ate.interval.high


def test_metrics_are_in_the_units_of_their_names(validated):
    row = rows_of(validated)["prediction"]
    found = metrics(row)
    assert found["ate_m"] == row.errors.ate
    assert found["yaw_rms_deg"] == pytest.approx(np.degrees(row.errors.yaw))
    assert found["radius_tracked_m"] == row.errors.radius[1]
    assert found["crps_yaw_deg"] == pytest.approx(np.degrees(row.scores.crps[2]))
    level = list(row.scores.levels).index(0.9)
    assert found["coverage90_x"] == row.scores.coverage[level, 0]
    assert found["width90_yaw_deg"] == pytest.approx(np.degrees(row.scores.width[level, 2]))
    assert {"nees", "nees_low", "nees_high", "nees_p"} <= set(found)
    assert "coverage90_x" not in metrics(rows_of(validated)["no-slip"])


def test_errors_of_every_pose_and_model_are_in_the_table(validated, walk):
    table = pd.read_csv(walk / "validation" / "errors.csv")
    for name, row in rows_of(validated).items():
        mine = table[table.model == name]
        assert len(mine) == row.errors.poses
        rms = np.sqrt(np.mean(mine.x_m**2 + mine.y_m**2))
        assert rms == pytest.approx(row.errors.ate, rel=1e-6)
