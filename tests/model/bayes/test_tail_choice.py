# SPDX-License-Identifier: MIT
"""The noise has tails as heavy as the data."""

import pytest

from model.bayes.laplace import LaplaceMixture, find_mode
from model.bayes.tail_choice import choose_tail
from support.dropped_forces import KNOWN, posterior_of, simulated


@pytest.mark.parametrize(("dropped", "tails"), [(0.05, {3.0, 5.0}), (0.0, {30.0})])
def test_tails_are_as_heavy_as_the_data_have_them(dropped, tails):
    posterior = posterior_of(simulated(1, dropped))
    gauss = find_mode(posterior.log_density, posterior.coordinates(KNOWN)[None])
    chosen = choose_tail(posterior, LaplaceMixture((gauss,)))
    assert chosen.posterior.tail in tails
    assert (chosen.gain[chosen.posterior.tail] > 10) == (dropped > 0)
