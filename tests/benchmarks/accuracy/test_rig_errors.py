# SPDX-License-Identifier: MIT
import pytest
from scipy.stats import binom

from benchmarks.accuracy.rig_errors import TERMS, fit_seed, table

SEEDS = 60


def test_a_rig_is_fitted_with_the_terms_and_without():
    whole, plain = fit_seed(0, one_sided=False, duration=0.1)
    assert set(TERMS) <= set(whole.held)
    assert not set(TERMS) & set(plain.held)
    assert max(abs(score) for score in whole.score.values()) < 4
    assert len(table([whole])) == len(whole.held)


@pytest.mark.long
@pytest.mark.parametrize("one_sided", [False, True])
def test_intervals_hold_at_their_rate_with_the_terms_and_on_one_side_not_without(one_sided):
    pairs = [fit_seed(seed, one_sided=one_sided) for seed in range(SEEDS)]
    low, high = binom.interval(0.998, SEEDS, 0.9)
    for name in pairs[0][0].held:
        assert low <= sum(whole.held[name] for whole, _ in pairs) <= high, name
    if one_sided:  # errors of both sides cancel in part
        for name in ("slip_stiffness", "friction"):
            assert sum(plain.held[name] for _, plain in pairs) < 0.5 * SEEDS
