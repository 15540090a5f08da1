# SPDX-License-Identifier: MIT
"""Faults planted under the drivers: nothing wrong is handed on, and what is lost is counted."""

import numpy as np
import pytest

from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import DeviceMismatch
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import SimulatedImu
from rig.links.byte_link import MemoryLink
from rig.links.faults import Faults
from rig.twins import robot_twin
from rig.zebro.profile import encode_counts, load_leg_profile
from support.leg_twins import GAIT, SERIAL, read, stream_of


def true_counts(samples):
    theta = GAIT.angles([sample.sequence / SERIAL.rate for sample in samples])
    return [encode_counts(SERIAL, row) for row in theta]


@pytest.mark.parametrize(
    "faults",
    [
        Faults(flip=1e-4),
        Faults(flip=1e-3),
        Faults(flip=1e-2),
        Faults(drop=0.2),
        Faults(truncate=0.1),
        Faults(duplicate=0.2),
        Faults(delay=0.2),
        Faults(garbage=0.3),
        Faults(noise_at_start=5000),
        Faults(flip=1e-3, drop=0.05, truncate=0.05, duplicate=0.05, delay=0.05, garbage=0.1),
    ],
    ids=str,
)
def test_no_wrong_sample_is_handed_on_and_every_missing_one_is_counted(faults):
    samples, counters = read(faults)
    assert [sample.counts for sample in samples] == true_counts(samples)
    numbers = [sample.sequence for sample in samples]
    assert np.all(np.diff(numbers) > 0)
    assert counters.received + counters.lost == numbers[-1] - numbers[0] + 1
    assert len(samples) > 100


def test_damage_is_counted_and_so_is_finding_back():
    _, counters = read(Faults(truncate=0.1))
    assert counters.damaged > 50
    assert 0 < counters.resynchronised <= counters.damaged


def test_another_device_at_the_port_is_named_as_a_mismatch():
    imu = SimulatedImu(
        profile=load_imu_profile("imu-quaternion-serial"), rng=np.random.default_rng(0)
    )
    stream, clock, _ = stream_of(SERIAL, Faults(), twin=imu)
    with stream, pytest.raises(DeviceMismatch, match="ports swapped"):
        list(iterate(stream, duration=5.0, clock=clock))


def test_half_a_frame_from_before_a_gap_does_not_spoil_the_first_one_after_it():
    class Replugged:
        source = "sim:zebro"
        reconnected = 0

        def __init__(self):
            twin = robot_twin(SERIAL, GAIT, rng=np.random.default_rng(0))
            frames = [twin.poll(k / 100, b"") for k in range(4)]
            self.reads = [frames[0] + frames[1][:9], frames[2] + frames[3]]

        def open(self):
            self.connected = True

        def close(self):
            self.connected = False

        def read(self, timeout):
            self.reconnected = int(len(self.reads) == 1)
            return self.reads.pop(0)

    with leg_driver(SERIAL, Replugged(), clock=ManualClock()) as stream:
        numbers = [s.sequence for _ in range(2) for s in stream.read(0.1)]
    assert numbers == [0, 2, 3]
    assert stream.counters.damaged == 0


def test_counts_beyond_the_circle_are_refused():
    clock = ManualClock()
    fine = load_leg_profile("zebrobus-uart")
    twin = robot_twin(fine, GAIT, rng=np.random.default_rng(0))
    coarse = load_leg_profile("zebrobus-uart")
    object.__setattr__(coarse, "counts_per_revolution", 100)
    with leg_driver(coarse, MemoryLink(twin, clock=clock), clock=clock) as stream:
        list(iterate(stream, duration=5.0, clock=clock))
    assert stream.counters.refused > 100


def test_a_poll_whose_answer_is_cut_is_not_mixed_with_the_next():
    profile = load_leg_profile("zebrobus-uart")
    samples, counters = read(Faults(truncate=0.2, drop=0.1), 20.0, profile)
    assert counters.damaged > 50
    assert counters.resynchronised > 0
    # every leg turns at 4 rad/s: never a jump, as of a value taken for another leg's
    turned = np.diff([sample.counts for sample in samples], axis=0)
    expected = np.diff([sample.host_time for sample in samples]) * 4.0 / (2 * np.pi) * 910
    error = (turned - expected[:, None] + 455) % 910 - 455
    assert np.all(np.abs(error) < 910 * 4.0 * 0.03 / (2 * np.pi))


def test_an_answer_that_comes_too_late_is_never_taken_for_the_next_one():
    class Late:
        """Answers the k-th request with k, every fifth too late."""

        source = "sim:zebro"
        requests = 0
        due = ()

        def poll(self, now, received):
            if received:
                self.requests += 1
                when = now + (0.055 if self.requests % 5 == 0 else 0.01)
                self.due = (*self.due, (when, self.requests))
            ready = [k for when, k in self.due if when <= now]
            self.due = tuple(item for item in self.due if item[0] > now)
            return b"".join(6 * k.to_bytes(2, "big") for k in ready)

    twin = Late()
    stream, *_ = stream_of(load_leg_profile("zebrobus-uart"), Faults(), twin=twin)
    with stream:
        for _ in range(200):
            for sample in stream.read(0.2):
                assert sample.counts == (twin.requests,) * 6
    assert stream.counters.damaged == twin.requests // 5
    assert stream.counters.received == twin.requests - twin.requests // 5


@pytest.mark.parametrize("faults", [Faults(truncate=0.1), Faults(drop=0.2), Faults(garbage=0.2)])
def test_a_dump_keeps_its_values_apart_through_faults_of_whole_frames(faults):
    profile = load_leg_profile("vregs-dump")
    samples, _ = read(faults, 20.0, profile)
    assert len(samples) > 500
    steps = np.diff([sample.counts[0] for sample in samples]) % 910
    assert np.all(steps < 910 * 4.0 * 0.3 / (2 * np.pi))
