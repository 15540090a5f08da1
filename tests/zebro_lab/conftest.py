# SPDX-License-Identifier: MIT
"""What tests of stages and commands share: running a command, a simulated sweep, a walked path."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from model.walk.path import WalkPath
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.commands import Ended, within_process
from support.simulated_sweep import simulate_sweep

COLUMNS = """
source = "sim:rig-sweep"
runs.by = ["run"]
load_cell.zero_stability = "0.1 N"
"""


@pytest.fixture
def run_command(monkeypatch, capsys) -> Callable[..., Ended]:
    """Return what runs `zebro-lab` with arguments in this process."""
    return within_process(monkeypatch, capsys)


@pytest.fixture(scope="session")
def sweep(tmp_path_factory) -> Path:
    """Return a folder with one CSV of 24 runs, 3,600 samples, and its columns.toml.

    The truth behind it is `THESIS_VALUES` of `THESIS_LAW`.
    """
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.9, 12) ** 1.5), loads=(4.0, 12.0), rate=150.0)
    rng = np.random.default_rng(1)
    simulated = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng
    )
    folder = tmp_path_factory.mktemp("sweep")
    table = pd.DataFrame(simulated.table).assign(
        radius_leg=plan.radius_leg, radius_ground=plan.radius_ground
    )
    table.to_csv(folder / "sweep.csv", index=False)
    (folder / "columns.toml").write_text(COLUMNS)
    return folder


@pytest.fixture(scope="session")
def walked() -> WalkPath:
    """Return a made-up tripod walk of 4 s to the left, 100 Hz: two cycles of 2 s.

    No model made it, so that those who write, read or draw paths are tested apart from models.
    """
    t = np.arange(0.0, 4.005, 0.01)
    yaw = 0.15 * t
    position = np.column_stack([0.5 * np.sin(yaw), 0.5 * (1 - np.cos(yaw)), np.full_like(t, 0.06)])
    orientation = np.column_stack([0.02 * np.sin(np.pi * t), 0.01 * np.cos(np.pi * t), yaw])
    odd = np.array([True, False, False, True, True, False])  # {1, 4, 5} stand first
    contact = (np.floor(t)[:, None] % 2 == 0) == odd
    phase = (t[:, None] + np.where(odd, 0.0, 1.0)) % 2.0
    turns = np.floor((t[:, None] + np.where(odd, 0.0, 1.0)) / 2.0)
    stance, flight = 0.9 + 1.2 * phase, 2.1 + (phase - 1) * (2 * np.pi - 1.2)
    theta = np.where(phase < 1, stance, flight) + 2 * np.pi * turns
    share = np.where(contact, 2.17 * 9.81 / 3, 0.0)
    wave = np.sin(2 * np.pi * t)[:, None] * np.array([1.0, 0.8, 1.2, -1.0, 0.6, -0.7])
    slip = np.where(contact, 0.01 * wave, 0.0)
    return WalkPath(
        t=t,
        position=position,
        orientation=orientation,
        theta=theta,
        contact=contact,
        slip_velocity=np.stack([slip, -slip / 2], axis=-1),
        slip_ratio=np.where(contact, 0.1 * wave, np.nan),
        normal_force=share,
        traction_force=np.stack([0.2 * share * wave, -0.1 * share * wave], axis=-1),
    )
