# SPDX-License-Identifier: MIT
"""A repeatable option holds for the file at its place, the last for those after it."""

import pytest

from zebro_lab.track.trajectory.request import of_file


@pytest.mark.parametrize(
    ("given", "expected"), [((), (None, None)), ((1,), (1, 1)), ((1, 2), (1, 2))]
)
def test_the_last_value_holds_for_files_after_it(given, expected):
    assert tuple(of_file(given, which) for which in (0, 1)) == expected
