# SPDX-License-Identifier: MIT
from importlib.util import find_spec

import pytest

from benchmarks.speed import walking


def test_mujoco_walks_the_same_turn_or_its_absence_is_said(monkeypatch, capsys):
    if find_spec("mujoco") is None:
        walking.time_mujoco({})
        assert "No tables for MuJoCo: No module named 'mujoco'" in capsys.readouterr().out
        return
    from benchmarks.speed import walking_mujoco as peer

    monkeypatch.setattr(peer, "STUDY_CYCLES", 3)
    one = peer.run(walking.ROBOT, walking.gait(), 0.38, peer.Setup(dt=0.004), duration=6.0)
    ours = walking.radius(walking.laws()[f"Coulomb, mu {walking.FRICTION}"], 0.002)
    assert one.radius == pytest.approx(ours, rel=0.1)
