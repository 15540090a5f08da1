# SPDX-License-Identifier: MIT
"""Offset and drift are found while recording, times after it, whatever the device's clock does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig import clock_watch
from rig.clock_watch import ClockWatch, fit_clock, sample_times
from rig.device import Sample
from rig.errors import ProtocolError
from rig.sample_columns import SampleColumns

DRIFT = 5e-5


def batches(start, seconds, rate=1000.0, offset=7.0, rng=None):
    """Return what reads of 4 ms give of a device that runs slow, its samples some time late."""
    rng = rng or np.random.default_rng(0)
    device = np.arange(0, seconds, 1 / rate)
    taken = start + offset + (1 + DRIFT) * device
    found = []
    for first in range(0, len(device), 4):
        read = taken[min(first + 3, len(taken) - 1)] + rng.exponential(3e-4)
        found.append([Sample(read, d, i, (0,)) for i, d in enumerate(device[first : first + 4],
                                                                     first)])  # fmt: skip
    return found, taken


def as_stream(found, *, sequence=True):
    samples = [sample for batch in found for sample in batch]
    n = len(samples)
    return SampleColumns(
        np.array([s.host_time for s in samples]),
        np.array([np.nan if s.device_time is None else s.device_time for s in samples]),
        np.arange(n) if sequence else np.full(n, -1),
        np.zeros(n, dtype="u4"), np.zeros(n, dtype="u4"), np.zeros((n, 1), dtype="i4"),
    )  # fmt: skip


def test_offset_and_drift_are_found_from_least_late_samples():
    found, _ = batches(100.0, 30.0)
    watch = ClockWatch(start=100.0)
    for batch in found:
        watch.add(batch)
    result = watch.result()
    assert result["offset"] == pytest.approx(7.0, abs=2e-4)
    assert result["drift"] == pytest.approx(DRIFT, abs=1e-5)


def test_after_a_restart_the_clock_that_runs_now_counts():
    watch = ClockWatch(start=0.0)
    for offset, start in ((7.0, 0.0), (90.0, 10.0)):
        for batch in batches(start, 10.0, offset=offset)[0]:
            watch.add(batch)
    assert watch.result()["offset"] == pytest.approx(100.0, abs=1e-3)


@pytest.mark.parametrize("restart", [None, 2000.0])
def test_a_long_watch_keeps_as_many_pairs_as_a_short_one_and_tells_as_much(monkeypatch, restart):
    monkeypatch.setattr(clock_watch, "MOST_PAIRS", 1000)
    watch, rng = ClockWatch(start=0.0), np.random.default_rng(0)
    for t in np.arange(0.0, 4000.0, 0.05):
        zero = 7.0 if restart is None or t < restart else 7.0 + restart
        late = rng.exponential(3e-4)
        watch.add([Sample(t + late, float((t - zero) / (1 + DRIFT)), 0, (0,))])
        assert len(watch._host) == len(watch._device) <= 1000
    assert len(watch._host) > 500
    result = watch.result()
    assert result["offset"] == pytest.approx(zero, abs=1e-4)
    assert result["drift"] == pytest.approx(DRIFT, abs=1e-6)


def test_a_device_without_a_clock_has_no_result():
    watch = ClockWatch(start=0.0)
    watch.add([Sample(1.0, None, None, (0,))])
    watch.add([])
    assert watch.result() is None


def test_times_undo_the_batches_of_reading():
    found, taken = batches(0.0, 10.0)
    stream = as_stream(found)
    assert np.abs(stream.host_time - taken).max() > 2e-3
    np.testing.assert_allclose(sample_times(stream), taken, atol=3e-4)


def test_each_stretch_between_restarts_is_fitted_for_itself():
    first, taken_first = batches(0.0, 5.0)
    second, taken_second = batches(60.0, 5.0)
    times = sample_times(as_stream(first + second))
    np.testing.assert_allclose(times, np.r_[taken_first, taken_second], atol=3e-4)


def test_a_lost_device_time_is_bridged_by_number():
    found, taken = batches(0.0, 5.0)
    stream = as_stream(found)
    stream.device_time[100:103] = np.nan
    np.testing.assert_allclose(sample_times(stream), taken, atol=3e-4)


def test_without_device_times_the_time_of_reading_stays():
    stream = as_stream(batches(0.0, 1.0)[0], sequence=False)
    stream.device_time[:] = np.nan
    np.testing.assert_array_equal(sample_times(stream), stream.host_time)


@pytest.mark.parametrize("stalls", [(9.8,), (3.0, 9.7)])
def test_reading_late_is_no_restart_and_keeps_the_clocks_compared(stalls):
    watch = ClockWatch(start=0.0)
    for number, t in enumerate(np.arange(0.0, 10.0, 0.06)):
        late = any(stall <= t < stall + 0.1 for stall in stalls)
        watch.add([Sample(t + 7.0 + (1.6 if late else 0.001), float(t), number, (0,))])
    found = watch.result()
    assert found is not None
    assert found["offset"] == pytest.approx(7.001, abs=2e-3)
    assert abs(found["drift"]) < 1e-3


@pytest.mark.parametrize("last", [0.0, 0.01])
def test_a_device_clock_that_stands_still_is_named_and_leaves_the_times_of_reading(last):
    read = 0.06 * np.arange(20)
    found = [[Sample(t, 5.0 + last * (t == read[-1]), k, (0,))] for k, t in enumerate(read)]
    watch = ClockWatch(start=0.0)
    for batch in found:
        watch.add(batch)
    with pytest.raises(ProtocolError, match="times do not increase: 5 s early"):
        watch.result()
    np.testing.assert_array_equal(sample_times(as_stream(found)), read)


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
