# SPDX-License-Identifier: MIT
"""Dumps and polls: cut and late answers are never mixed up."""

import numpy as np
import pytest

from rig.links.faults import Faults
from rig.zebro.profile import load_leg_profile
from support.leg_twins import read, stream_of


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
