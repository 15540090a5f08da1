# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from rig.clock import ManualClock
from rig.errors import NotAtRest
from rig.experiment.readings import Batch, join
from rig.experiment.rest import prove_rest

PERIOD = 0.01


def batch(leg, ground, *, taken):
    """Make a look that brought these speeds [rad/s], all taken at one time [s]."""
    return Batch(
        readings=join([]), normal=np.empty(0), traction=np.empty(0),
        speeds={"leg": np.array(leg, float), "ground": np.array(ground, float)},
        arrived={}, further={}, taken={"board": np.full(len(leg), taken)}, fault="", raw={},
    )  # fmt: skip


def prove(speed_at, *, age=0.0, longest=1.0, limit=0.1, oldest=0.25):
    """Prove rest of a leg disc of such speed; return how long it took [s]."""
    clock = ManualClock()

    def look():
        clock.sleep(PERIOD)
        speeds = speed_at(clock.now())
        return batch(speeds, np.zeros(len(speeds)), taken=clock.now() - age)

    prove_rest(look, limit, longest=longest, clock=clock, oldest=oldest)
    return clock.now()


def test_discs_that_stand_are_proved_to_over_a_whole_window():
    assert prove(lambda t: [0.0]) == pytest.approx(0.26, abs=0.02)


def test_an_encoder_may_be_noisier_than_the_limit():
    rng = np.random.default_rng(0)
    took = [prove(lambda t: rng.normal(0.0, 0.3, 5), longest=2.0) for _ in range(100)]
    assert np.median(took) < 0.3


@pytest.mark.parametrize(
    ("speed_at", "said"),
    [
        (
            lambda t: [0.15],
            "its mean speed over 0.25 s is 0.15 rad/s; .* at most 0.1 rad/s",
        ),
        (lambda t: [np.nan], "its mean speed over 0.25 s is nan rad/s"),
        (lambda t: [3.0, -3.0], "its speed oscillates, with a root mean square of 3 rad/s"),
        (lambda t: [], "its speed was read 0 times in 0.25 s, or since .* older than 0.25 s .exp"),
        (lambda t: [0.0] if t % 0.1 < 0.01 else [], "its speed was read [23] times"),
    ],
    ids=["creeping", "no number", "swinging", "silent", "seldom"],
)
def test_what_does_not_stand_is_no_rest(speed_at, said):
    with pytest.raises(NotAtRest, match=rf"leg disc did not come to rest within 1 s: {said}"):
        prove(speed_at)


def test_readings_that_waited_are_no_proof():
    with pytest.raises(NotAtRest):
        prove(lambda t: [0.0], age=0.3)
    assert prove(lambda t: [0.0], age=0.3, oldest=0.4) < 0.3


def test_a_disc_that_has_just_come_to_rest_is_waited_for():
    assert 0.35 < prove(lambda t: [12.0 * np.exp(-t / 0.05)]) < 0.5
