# SPDX-License-Identifier: MIT
"""Faults planted at the byte stream, under the real drivers, on a clock turned by hand."""

import numpy as np
import pytest

from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import DeviceMismatch
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import SimulatedImu
from rig.links.faults import Faults
from rig.twins import robot_twin
from rig.zebro.profile import encode_counts
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
