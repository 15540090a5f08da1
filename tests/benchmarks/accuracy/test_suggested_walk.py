# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy import suggested_walk
from benchmarks.accuracy.suggested_walk import PARTS, poses_of, true_pose
from model.slip.thesis import THESIS_VALUES


def test_ends_of_drawn_laws_are_about_the_true_end(monkeypatch):
    monkeypatch.setattr(suggested_walk, "DURATION", 2.0)
    monkeypatch.setattr(suggested_walk, "WALKED", 6)
    true = true_pose()
    spread = np.random.default_rng(1).normal(1.0, 0.01, (8, 4))
    found = poses_of(np.array(THESIS_VALUES) * spread)
    assert set(found) == set(true) == set(PARTS)
    for name in PARTS:
        assert found[name].std() > 0
        assert true[name] == pytest.approx(found[name].mean(), abs=4 * found[name].std())
