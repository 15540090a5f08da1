# SPDX-License-Identifier: MIT
"""Twins served at a port."""

from rig.links.serve import Ticker


def test_a_twin_that_raises_is_kept_for_its_owner_to_see(wait_until):
    def fail(now):
        raise RuntimeError("broken")

    with Ticker(fail) as ticker:
        wait_until(lambda: ticker.failure)
    assert isinstance(ticker.failure, RuntimeError)
