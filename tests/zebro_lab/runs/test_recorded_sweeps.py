# SPDX-License-Identifier: MIT
"""A recording of a rig that sweeps by itself is numbered by its sweeps."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.runs.folder import SlipRigRun
from zebro_lab.runs.recorded_sweeps import recorded_sweeps
from zebro_lab.runs.slip_rig_table import SlipRigTable

T = np.arange(0.0, 6.0, 0.005)
RADII = {"radius_leg": 0.035, "radius_ground": 0.12}


def run(slip: np.ndarray, omega_leg: float = 12.0) -> SlipRigRun:
    leg = np.full_like(T, omega_leg)
    ground = (1 - slip) * leg * RADII["radius_leg"] / RADII["radius_ground"]
    table = SlipRigTable(T, leg, ground, np.full_like(T, 5.0), np.full_like(T, 1.0))
    return SlipRigRun(Path("a-run"), SimpleNamespace(constants=RADII), table, ())


def test_sweeps_are_numbered_from_one_and_jumps_belong_to_none():
    number, (note,) = recorded_sweeps(run(0.9 * (T % 2.0) / 2.0))
    assert [int(number[np.searchsorted(T, t)]) for t in (1.0, 3.0, 5.0)] == [1, 2, 3]
    between = (number == 0) & (T > 0.5) & (T < 5.5)
    assert np.all(np.abs((T[between] + 1) % 2.0 - 1) < 0.5)
    left_out = np.mean(number == 0)
    assert 0 < left_out < 0.4
    assert note == (f"a-run: {left_out:.1%} of the samples are ignored, because slip jumped "
                    "between two sweeps or the leg disc stood still")  # fmt: skip


def test_one_sweep_is_kept_whole_without_a_note():
    number, notes = recorded_sweeps(run(T / 10))
    assert set(number) == {1}
    assert notes == ()


def test_a_disc_that_never_turns_is_named():
    with pytest.raises(DataError, match=r"a-run.log\.mcap: the leg disc never turned"):
        recorded_sweeps(run(np.zeros_like(T), omega_leg=0.0))
