# SPDX-License-Identifier: MIT
from benchmarks.speed import prediction


def test_a_prediction_of_a_short_walk_is_timed(monkeypatch, tmp_path, calibration):
    monkeypatch.setattr(prediction, "DURATION", 4.0)
    walk = prediction.write_walk(tmp_path / "walk", 1.1, "left", calibration, 1)
    wall, processor = prediction.took(
        prediction.BIN / "zebro-lab", "predict", walk / "legs.csv", "--slip", calibration,
        "--draws", 10, "--out", tmp_path / "prediction",
    )  # fmt: skip
    assert float(wall) > 0
    assert float(processor) > 0
    assert (walk / "track" / "track.csv").is_file()
