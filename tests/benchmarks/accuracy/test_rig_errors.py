# SPDX-License-Identifier: MIT
import pytest
from scipy.stats import binom

from benchmarks.accuracy.rig_errors import TERMS, TOLD, WITH, WITHOUT, fit_seed, table

SEEDS = 60


def test_a_rig_is_fitted_with_the_terms_and_without():
    found = fit_seed(0, one_sided=False, everything=True, duration=0.1)
    whole, plain = found[WITH], found[WITHOUT]
    assert set(TERMS) <= set(whole.held) == set(found[TOLD].held)
    assert not set(TERMS) & set(plain.held)
    assert max(abs(score) for score in whole.score.values()) < 4
    assert len(table([whole])) == len(whole.held)


@pytest.mark.long
@pytest.mark.parametrize("one_sided", [False, True])
def test_intervals_hold_at_their_rate_with_the_terms_and_on_one_side_not_without(one_sided):
    fits = [fit_seed(seed, one_sided=one_sided) for seed in range(SEEDS)]
    low, high = binom.interval(0.998, SEEDS, 0.9)
    for name in fits[0][WITH].held:
        assert low <= sum(fit[WITH].held[name] for fit in fits) <= high, name
    if one_sided:  # errors of both sides cancel in part
        for name in ("slip_stiffness", "friction"):
            assert sum(fit[WITHOUT].held[name] for fit in fits) < 0.5 * SEEDS
