# SPDX-License-Identifier: MIT
"""One suite for every stream: the real driver over its twin, and replay of what it gave."""

import time
from contextlib import contextmanager
from functools import partial

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.clock import SYSTEM_CLOCK, ManualClock
from rig.device import iterate
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import SimulatedImu
from rig.imu.stream import ImuStream
from rig.links.byte_link import MemoryLink
from rig.replay import ReplayStream
from rig.slip_rig.board import RigBoard
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.twins import robot_twin, simulated_legs, simulated_rig_devices
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated_legs import SimulatedLegs
from support.board_twins import world

TIMES = np.linspace(0, 60, 601)
GAIT = SampledReference(TIMES, np.outer(TIMES, np.full(6, 4.0)) + np.arange(6))


def rng():
    return np.random.default_rng(3)


def in_memory(twin, driver):
    """Serve a twin of bytes without port or thread, on a clock turned by hand."""

    @contextmanager
    def serve():
        clock = ManualClock()
        yield driver(MemoryLink(twin(), clock=clock), clock=clock)

    return serve


def legs(name):
    profile = load_leg_profile(name)
    return in_memory(lambda: robot_twin(profile, GAIT, rng=rng()), partial(leg_driver, profile))


def can_legs():
    profile = load_leg_profile("zebro-100-can")
    return simulated_legs(SimulatedLegs(GAIT, profile=profile), rng=rng())


def rig_stream(stream):
    @contextmanager
    def serve():
        with simulated_rig_devices(
            load_rig_profile("rig-odrive-netft"), world(imperfections=TYPICAL_RIG), rng=rng()
        ) as devices:
            yield getattr(devices, stream)

    return serve


IMU = load_imu_profile("imu-quaternion-serial")
BOARD = load_rig_profile("rig-board-serial")
LIVE = {
    "legs on serial packets": legs("zebro-100-serial"),
    "legs on CAN": can_legs,
    "legs from a dump": legs("vregs-dump"),
    "legs polled": legs("zebrobus-uart"),
    "imu": in_memory(lambda: SimulatedImu(profile=IMU, rng=rng()), partial(ImuStream, profile=IMU)),
    "drives": rig_stream("drives"),
    "load cell": rig_stream("load_cell"),
    "board": in_memory(
        lambda: SimulatedBoard(world(imperfections=TYPICAL_RIG), profile=BOARD.board, rng=rng()),
        partial(RigBoard, profile=BOARD.board, limits=BOARD.limits),
    ),
}
NUMBERED = {"legs on serial packets", "legs on CAN", "imu", "load cell", "board"}


@pytest.fixture(scope="module", params=LIVE)
def recorded(request, take):
    """Return a stream's name in the suite, the closed stream, and some of what it gave."""
    with LIVE[request.param]() as stream:
        with stream:
            samples = take(stream, 20)
        return request.param, stream, samples


def test_a_twin_says_that_it_is_simulated(recorded):
    _, stream, _ = recorded
    assert stream.source.startswith("sim:")


def test_every_sample_is_counted_and_none_is_rejected(recorded):
    _, stream, samples = recorded
    assert stream.counters.received == len(samples)
    assert stream.counters.rejected == 0
    assert stream.counters.lost == 0


def test_host_time_never_runs_back_and_lies_in_the_reading(recorded):
    _, _, samples = recorded
    times = np.array([sample.host_time for sample in samples])
    assert np.all(np.diff(times) >= 0)
    assert times[-1] <= time.monotonic()


def test_numbers_grow_by_one_where_the_protocol_has_them(recorded):
    name, _, samples = recorded
    numbers = [sample.sequence for sample in samples]
    if name in NUMBERED:
        assert np.all(np.diff(numbers) == 1)
        device = np.array([sample.device_time for sample in samples])
        assert np.all(np.diff(device) > 0)
    else:
        assert set(numbers) == {None}


def test_a_replay_gives_what_was_recorded_but_the_host_time(recorded):
    name, _, samples = recorded
    clock = ManualClock(1000.0)
    replay = ReplayStream(samples, name=name, source="replay:RUN", clock=clock)
    with replay:
        again = list(iterate(replay, duration=1.0, clock=clock))
    assert [s[1:] for s in again] == [s[1:] for s in samples]
    shift = again[0].host_time - samples[0].host_time
    np.testing.assert_allclose(
        [s.host_time for s in again], [s.host_time + shift for s in samples], atol=1e-9
    )
    assert replay.source == "replay:RUN"
    assert (replay.counters.received, replay.finished) == (len(samples), True)


@pytest.mark.parametrize("name", LIVE)
def test_a_read_without_news_ends_in_time(name):
    with LIVE[name]() as stream, stream:
        stream.read(0.05)
        began = SYSTEM_CLOCK.now()
        for _ in range(10):
            stream.read(0.0)
        assert SYSTEM_CLOCK.now() - began < 0.7


@pytest.mark.parametrize("name", LIVE)
def test_a_stream_can_be_closed_and_opened_again(name, take):
    with LIVE[name]() as stream:
        for _ in range(2):
            with stream:
                assert take(stream, 1)


@pytest.mark.parametrize("name", ["zebro-100-serial", "vregs-dump", "zebrobus-uart"])
def test_a_twin_on_a_clock_turned_by_hand_gives_the_same_every_time(name):
    def run():
        clock = ManualClock()
        profile = load_leg_profile(name)
        twin = robot_twin(profile, GAIT, rng=rng())
        stream = leg_driver(profile, MemoryLink(twin, clock=clock), clock=clock)
        with stream:
            return list(iterate(stream, duration=5.0, clock=clock)), profile

    (first, profile), (second, _) = run(), run()
    assert first == second
    assert len(first) == pytest.approx(5.0 * profile.rate, abs=3)
