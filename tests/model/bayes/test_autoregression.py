# SPDX-License-Identifier: MIT
"""Noise that follows that before it is whitened, run by run."""

import numpy as np
import pytest

from model.bayes.autoregression import centred, memory_of, run_variances, whitened

MEMORY = np.array([0.5, 0.2])
RUN = np.repeat([0, 1, 2], [4000, 3000, 2000])
SIZE = np.array([1.0, 4.0, 0.25])  # variance of what is fresh in each run


@pytest.fixture(scope="module")
def noise():
    rng = np.random.default_rng(1)
    fresh = np.sqrt(SIZE[RUN]) * rng.standard_normal(len(RUN))
    out = np.zeros(len(RUN))
    for k in range(2, len(RUN)):
        inside = RUN[k - 2] == RUN[k]
        out[k] = fresh[k] + inside * (MEMORY @ [out[k - 1], out[k - 2]])
    return out


def test_memory_and_size_are_those_of_the_noise(noise):
    found = memory_of(centred(noise, RUN), RUN, 1 / SIZE, order=2)
    np.testing.assert_allclose(found, MEMORY, atol=0.05)
    white, run = whitened(noise, RUN, found)
    assert len(white) == len(RUN) - 2 * 3  # the first two of each run have none before
    np.testing.assert_allclose(run_variances(white, run, 3), SIZE, rtol=0.1)
    assert abs(np.corrcoef(white[1:], white[:-1])[0, 1]) < 0.03


def test_noise_without_variance_has_no_memory():
    zero = np.zeros(len(RUN))
    np.testing.assert_array_equal(memory_of(zero, RUN, 1 / SIZE, order=2), [0.0, 0.0])


def test_a_run_alone_in_its_mean_has_the_typical_size(noise):
    found = run_variances(np.array([1.0, -1.0, 0.0]), np.array([0, 0, 1]), 2)
    assert found[1] == pytest.approx(1e-3 * 2.0)
