# SPDX-License-Identifier: MIT
import numpy as np

from benchmarks.speed import ensembles


def few(monkeypatch, **values):
    for name, value in values.items():
        monkeypatch.setattr(ensembles, name, value)


def test_every_gait_and_step_is_a_row_with_its_error_and_rates(monkeypatch, rows):
    few(monkeypatch, COMPARED=2, REPEATS=1, DURATION=1.0, STEPS=(0.005,), CONVERGED=0.001)
    ensembles.time_rates()
    table = rows()
    assert [row[:2] for row in table] == [["tripod", "5"], ["tetrapod", "5"]]
    assert all(float(row[4].removesuffix(" %")) < 5.0 for row in table)


def test_growth_counts_time_and_memory_of_logs_and_programs():
    log = ensembles.grown("log", 2, 1.0, 0)
    program = ensembles.grown("program", 2, 0.0, 2)
    assert np.all(np.array([log, program]) > 0)
