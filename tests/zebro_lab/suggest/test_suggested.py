# SPDX-License-Identifier: MIT
"""A suggestion in numbers has its points, times and expectations."""

from support.suggestions import suggested
from zebro_lab.suggest.suggested import points_of


def test_numbers_are_those_of_the_proposal():
    found = suggested()
    numbers = points_of(found)
    assert numbers["loads_N"] == [3.0, 9.0]
    assert [each["slip_ratio"] for each in numbers["slips"]] == found.proposal.slips.tolist()
    assert [each["points"] for each in numbers["slips"]] == found.proposal.counts.tolist()
    assert numbers["duration_s"] == found.proposal.seconds
    assert numbers["expected"][0]["sd_now"] == found.expected[0].sd_now
