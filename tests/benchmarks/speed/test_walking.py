# SPDX-License-Identifier: MIT
from benchmarks.speed import walking


def test_every_law_and_step_is_a_row_and_short_steps_cost_more(monkeypatch, rows):
    for name, few in (("DURATION", 1.0), ("REPEATS", 1), ("STEPS", (0.001, 0.008))):
        monkeypatch.setattr(walking, name, few)
    rates = walking.time_single_walks()
    table = rows()
    assert [row[1] for row in table] == ["1", "8"] * 2
    assert all(abs(float(row[3].removesuffix(" %"))) < 5.0 for row in table)
    assert set(rates) == {0.001, 0.008}


def test_every_plan_of_an_ensemble_is_a_row(monkeypatch, rows):
    few = {"DRAWS": (2, 4), "DURATIONS": (4.0, 6.0), "DURATION": 4.0, "ENSEMBLE_REPEATS": 1}
    for name, value in few.items():
        monkeypatch.setattr(walking, name, value)
    walking.time_ensembles()
    plans = [("2", "4"), ("4", "4"), ("4", "6"), *[("4", "4")] * 3]
    assert [tuple(row[1:3]) for row in rows()] == plans
