# SPDX-License-Identifier: MIT
import pytest

from model.counted import counted


@pytest.mark.parametrize(
    ("number", "expected"), [(0, "0 axes"), (1, "1 axis"), (2, "2 axes"), (-1, "-1 axes")]
)
def test_one_thing_alone_is_singular(number, expected):
    assert counted(number, "axis", "axes") == expected
