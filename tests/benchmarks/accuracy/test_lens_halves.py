# SPDX-License-Identifier: MIT
"""Lenses of halves of real sets differ as much as their standard deviations say."""

import pytest

from benchmarks.accuracy.lens_halves import SETS, ratio, seen_boards


@pytest.mark.long
@pytest.mark.reference
@pytest.mark.parametrize(("name", "model"), [("640 x 480", "full"), ("1920 x 1080", "k1-k2")])
def test_halves_of_a_real_set_differ_as_they_claim(shared, name, model):
    boards, size = seen_boards(shared, *SETS[name])
    found, pairs = ratio(boards, size, model)
    assert pairs >= 10
    assert 0.6 < found < 1.5
