# SPDX-License-Identifier: MIT
import cv2
import numpy as np
import pytest

from benchmarks.speed import tracking
from support.synthetic import look_at
from tracking.camera import Camera


@pytest.fixture(autouse=True)
def threads():
    before = cv2.getNumThreads()
    yield
    cv2.setNumThreads(before)


@pytest.mark.long
def test_both_detectors_find_every_marker_and_are_timed(monkeypatch, rows):
    for name, few in (("PHOTOS", 2), ("REPEATS", 1), ("STRETCHES", (2,))):
        monkeypatch.setattr(tracking, name, few)
    seen = look_at((0.8, -1.2, 1.8), (0.8, 0.6, 0.0), width=1200, height=900)
    monkeypatch.setattr(tracking, "CAMERA", seen)
    lens = Camera((1200, 900), seen.matrix, np.array(seen.distortion))
    monkeypatch.setattr(tracking, "LENS", lens)
    tracking.main()
    *detectors, path, few, many = rows()
    assert detectors[0][0] == "1"
    assert "processes" in detectors[-1][0]
    assert all(float(cell) > 0 for row in detectors for cell in row[1:])
    assert path[0] == "2"
    assert 0 < float(few[1]) < float(many[1])
