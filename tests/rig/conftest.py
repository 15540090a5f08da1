# SPDX-License-Identifier: MIT
"""Live twins are waited for, not timed: a busy machine may hold any thread up for a second."""

import time

import pytest

LIMIT = 20.0


def _wait_until(met, *, reading=None, limit=LIMIT):
    """Wait for a condition, reading a stream meanwhile where one is given; return what it gave."""
    end = time.monotonic() + limit
    samples = []
    while not met():
        assert time.monotonic() < end, f"still waiting after {limit} s"
        if reading is None:
            time.sleep(0.005)
        else:
            samples += reading.read(0.05)
    return samples


def _take(stream, count, *, limit=LIMIT):
    """Read a stream until it has given so many samples, or more."""
    end = time.monotonic() + limit
    samples = []
    while len(samples) < count:
        assert time.monotonic() < end, f"{len(samples)} of {count} samples in {limit} s"
        samples += stream.read(0.05)
    return samples


@pytest.fixture(scope="session")
def wait_until():
    return _wait_until


@pytest.fixture(scope="session")
def take():
    return _take
