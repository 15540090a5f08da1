# SPDX-License-Identifier: MIT
"""Device times undo batches, survive restarts, and are not fooled by drift."""

import numpy as np
import pytest

from rig.device import Sample
from rig.errors import DeviceFault
from rig.experiment.readings import HostTime


def test_device_time_undoes_batches_and_survives_a_restart():
    clock = HostTime()
    first = [Sample(10.02, 1.00 + 0.01 * k, k, ()) for k in range(3)]
    np.testing.assert_allclose(clock.map(first), [10.0, 10.01, 10.02])
    late = [Sample(10.09, 1.03, 3, ())]
    np.testing.assert_allclose(clock.map(late), [10.03], atol=1e-3)
    anew = [Sample(20.0, 0.0, 0, ())]
    np.testing.assert_allclose(clock.map(anew), [20.0])


def test_time_never_runs_back_where_a_quicker_sample_corrects_it():
    clock = HostTime()
    clock.map([Sample(10.05, 1.0, 0, ()), Sample(10.06, 1.01, 1, ())])  # 50 ms underway
    quick = clock.map([Sample(10.02, 1.02, 2, ()), Sample(10.10, 1.10, 3, ())])
    np.testing.assert_allclose(quick, [10.06, 10.10])


@pytest.mark.parametrize("drift", [-0.005, 0.005])
def test_an_hour_of_drift_is_not_taken_for_lateness(drift):
    clock = HostTime()
    host = 100.0 + 0.1 * np.arange(36_000)
    device = (1 + drift) * (host - 100.0)
    late = [h - clock.map([Sample(h, d, 0, ())])[0] for h, d in zip(host, device, strict=True)]
    assert max(late) < 0.01


def test_a_backlog_is_seen_however_long_it_stays():
    clock = HostTime()
    clock.map([Sample(10.0 + k / 100, k / 100, k, ()) for k in range(10)])
    for k in range(10, 110):  # half of real time
        taken = clock.map([Sample(10.0 + k / 50 - 0.1, k / 100, k, ())])
    assert 10.0 + 109 / 50 - 0.1 - taken[0] == pytest.approx(0.99, abs=0.05)


@pytest.mark.parametrize("rate", [1.05, 1.5, 10.0])
def test_a_clock_that_runs_too_fast_is_refused_since_its_readings_have_no_age(rate):
    clock, seen = HostTime(), []

    def run_for(seconds):
        for passed in np.arange(0, seconds, 0.01):
            seen.append(passed)
            clock.map([Sample(5.0 + passed, passed * rate, len(seen), ())])

    with pytest.raises(DeviceFault, match="clock ran ahead"):
        run_for(60.0)
    assert (seen[-1] - 1.0) * (rate - 1.01) == pytest.approx(1.0, abs=0.1)


def test_a_first_sample_that_waited_long_is_no_fast_clock():
    clock = HostTime()
    clock.map([Sample(8.0, 0.0, 0, ())])
    taken = [clock.map([Sample(8.0 + 0.01 * k, 3.0 + 0.01 * k, k, ())]) for k in range(1, 500)]
    np.testing.assert_allclose(np.ravel(taken), 8.0 + 0.01 * np.arange(1, 500))
