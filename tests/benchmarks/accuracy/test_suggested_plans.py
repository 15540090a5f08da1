# SPDX-License-Identifier: MIT
import numpy as np

from benchmarks.accuracy.suggested_plans import (
    EVEN,
    FORCES,
    QUADRATIC,
    RATE,
    STIFFNESS,
    base_plan,
    filled,
    intervals,
    joined,
    measured,
    pilot_of,
    quantities,
    rows,
    truths,
)
from model.slip.thesis import THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from zebro_lab.suggest.proposal import seconds_of


def test_plans_fill_the_time_and_the_pilot_is_short():
    plan = base_plan()
    assert 380 < seconds_of(filled(plan, 400.0, lambda n: np.linspace(0.0, 1.0, n))) <= 400
    assert seconds_of(pilot_of(plan)) < 150


def test_a_pilot_and_a_sweep_are_joined_run_by_run():
    pilot = pilot_of(base_plan())
    rng = np.random.default_rng(0)
    one = measured(pilot, TYPICAL_RIG, rng)
    both = joined(one, one)
    assert (one.n_runs, both.n_runs) == (16, 32)
    assert len(both) == 2 * len(one) == 2 * 16 * round(0.5 * RATE)
    assert np.all(np.diff(both.run) >= 0)


def test_quantities_of_the_true_law_are_the_truths():
    true = truths()
    assert true[STIFFNESS] == THESIS_VALUES[0]
    assert list(true) == [STIFFNESS, *FORCES]
    found = quantities(np.array(THESIS_VALUES) * np.ones((3, 1)))
    assert all(each.shape == (3,) for each in found.values())


def test_intervals_hold_nine_tenths_of_the_draws():
    found = intervals({"x": np.linspace(0.0, 1.0, 101)})
    assert np.allclose(found["x"], [0.45, 0.05, 0.95])


def test_a_row_compares_half_widths_seed_by_seed_and_counts_what_holds():
    def seed(wide, narrow):
        return {EVEN: {"x": [wide, 0.0, 1.0]}, QUADRATIC: {"x": [2 * narrow, 2.0, 3.0]},
                "x": {"x": [narrow, 0.0, 1.0]}}  # fmt: skip

    (row,) = rows([seed(1.0, 0.5), seed(1.0, 0.25), seed(2.0, 1.0)], {"x": ("x",)}, {"x": 0.5})
    assert row == ("x", "1", "1", "0.5", "+50 %", "+50 %", "3", "0", "3")
