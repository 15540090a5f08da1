# SPDX-License-Identifier: MIT
"""Offset and drift between two clocks are found under delays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.clock_fit import fit_clock
from rig.errors import ProtocolError


@given(st.floats(-1e4, 1e4), st.floats(-2e-4, 2e-4), st.integers(0, 2**32 - 1))
def test_offset_and_drift_are_found_under_delays_that_are_never_negative(offset, drift, seed):
    rng = np.random.default_rng(seed)
    device = np.arange(6000) / 100
    late = rng.exponential(0.003, len(device)) + 0.05 * (rng.random(len(device)) < 0.02)
    fit = fit_clock(device, offset + (1 + drift) * device + late)
    assert abs(fit.drift - drift) < 5e-6
    np.testing.assert_allclose(fit.to_host(device), offset + (1 + drift) * device, atol=4e-4)
    assert 0.001 < fit.delay < 0.004


def test_samples_of_one_time_compare_no_clocks():
    with pytest.raises(ProtocolError, match="do not increase: 0 s early and 0 s late in 100"):
        fit_clock(np.zeros(100), np.zeros(100))
    with pytest.raises(ProtocolError, match=r"found 9 samples .* expected at least 10"):
        fit_clock(np.arange(9.0), np.arange(9.0))


@pytest.mark.parametrize("seed", range(5))
def test_a_moment_of_samples_read_at_a_loss_tells_no_drift(seed):
    rng = np.random.default_rng(seed)
    device = np.arange(800) / 1000
    batch = np.maximum.accumulate(device + rng.exponential(0.02, 800))  # a host that is held up
    assert abs(fit_clock(device, 3.0 + batch).drift) < 4e-3


@pytest.mark.parametrize("duration", [2.0, 10.0, 60.0])
def test_offset_and_drift_lie_within_two_standard_uncertainties(duration):
    rng, inside = np.random.default_rng(2), []
    for _ in range(200):
        drift, offset = rng.normal(0, 1e-4), rng.normal()
        device = np.arange(0, duration, 0.05)
        host = offset + (1 + drift) * device + rng.exponential(0.003, len(device))
        fit = fit_clock(device, host)
        inside.append((abs(fit.drift - drift) < 2 * fit.drift_sd,
                       abs(fit.offset - offset) < 2 * fit.offset_sd))  # fmt: skip
    for share in np.mean(inside, axis=0):
        assert share > 0.87


@pytest.mark.parametrize(("samples", "tells"), [(15, False), (40, True), (1200, True)])
def test_a_moment_of_samples_does_not_tell_a_drift_and_says_so(samples, tells):
    rng = np.random.default_rng(3)
    device = np.arange(samples) / 20
    fit = fit_clock(device, 1 + device + rng.exponential(0.002, samples))
    assert fit.tells_drift == tells
