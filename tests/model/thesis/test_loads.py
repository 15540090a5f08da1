# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from model.thesis.loads import Balance, accelerations, normal_forces, static_loads
from model.thesis.traction import THESIS_TRACTION

WEIGHT = 2.17 * 9.81
INERTIA = np.array([0.01227, 0.00767])
JITTER = st.lists(st.floats(-0.02, 0.02), min_size=6, max_size=6)
SLIP = st.lists(st.floats(-0.2, 0.2), min_size=6, max_size=6)
WANTED = st.lists(st.floats(-60.0, 60.0), min_size=2, max_size=2)
SHARE = st.floats(0.3, 1.0)


def tripod(jitter=(0.0,) * 6):
    feet = np.array([[0.097, 0.1156, -0.06], [0.0, -0.1156, -0.06], [-0.097, 0.1156, -0.06]])
    feet[:, :2] += np.reshape(jitter, (3, 2))
    return feet


def balance(arms, slip=(0.0,) * 6, wanted=(0.0, 0.0)):
    return Balance(
        np.array(arms), np.eye(3), np.reshape(slip, (3, 2)).astype(float), INERTIA,
        np.array(wanted), np.empty((3, 3)),
    )  # fmt: skip


def solve(task, total, most=WEIGHT):
    loads = np.full(3, total / 3)
    normal_forces(task, THESIS_TRACTION, total, most, loads)
    return loads


def misfit(task, loads):
    excess, slopes = np.empty(2), np.empty((2, 3))
    accelerations(task, THESIS_TRACTION, np.ascontiguousarray(loads), excess, slopes)
    return float(excess @ excess)


@given(JITTER)
def test_static_loads_balance_a_weight_inside_the_triangle(jitter):
    feet, loads = tripod(jitter), np.empty(3)
    static_loads(feet, WEIGHT, loads)
    assert loads.sum() == pytest.approx(WEIGHT)
    np.testing.assert_allclose(loads @ feet[:, :2], 0.0, atol=1e-12)


@given(JITTER, SLIP, WANTED, SHARE)
def test_forces_keep_their_sum_and_bounds(jitter, slip, wanted, share):
    loads = solve(balance(tripod(jitter), slip, wanted), share * WEIGHT)
    assert loads.sum() == pytest.approx(share * WEIGHT)
    assert loads.min() >= 0.0
    assert loads.max() <= WEIGHT


@given(JITTER, SLIP, SHARE)
def test_inside_the_bounds_the_wanted_accelerations_are_met(jitter, slip, share):
    task = balance(tripod(jitter), slip, (1.0, -2.0))
    loads = solve(task, share * WEIGHT)
    if loads.min() > 0:
        assert misfit(task, loads) < 1e-12


@settings(max_examples=40)
@given(JITTER, SLIP, WANTED, SHARE)
def test_a_general_optimiser_finds_nothing_better(jitter, slip, wanted, share):
    task, total = balance(tripod(jitter), slip, wanted), share * WEIGHT
    loads = solve(task, total)
    found = minimize(
        lambda f: misfit(task, f),
        np.clip(loads + np.array([0.5, -1.0, 0.5]), 0, WEIGHT),
        method="SLSQP",
        bounds=[(0.0, WEIGHT)] * 3,
        constraints={"type": "eq", "fun": lambda f: f.sum() - total},
        options={"ftol": 1e-12, "maxiter": 200},
    )
    assert misfit(task, loads) <= found.fun * (1 + 1e-6) + 1e-6


def test_a_leg_never_pulls_however_fast_the_body_is_to_roll():
    loads = solve(balance(tripod(), wanted=(1e4, 0.0)), WEIGHT)
    np.testing.assert_allclose(np.sort(loads)[0], 0.0, atol=1e-12)


def test_without_weight_there_are_no_forces():
    np.testing.assert_array_equal(solve(balance(tripod(), wanted=(5.0, 5.0)), 0.0), 0.0)
