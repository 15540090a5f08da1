# SPDX-License-Identifier: MIT
"""Two paths of which one is in another unit draw a question, and paths that slip do not."""

import numpy as np
import pytest

from zebro_lab.validation.extents import unit_warning

PATH = np.column_stack([np.linspace(0, 2, 50), np.sin(np.linspace(0, 3, 50))])


def warned(scale, *, near=0.3):
    return unit_warning((PATH, "a.csv"), (scale * PATH, "b.csv"), near=near)


@pytest.mark.parametrize(
    ("scale", "larger", "units"),
    [(1000.0, "b.csv", "mm and m"), (0.001, "a.csv", "mm and m"), (39.4, "b.csv", "inches and m"),
     (750.0, "b.csv", "mm and m"), (0.01, "a.csv", "cm and m"), (85.0, "b.csv", "cm and m"),
     (3.281, "b.csv", "feet and m")],
)  # fmt: skip
def test_the_path_in_the_smaller_unit_is_named(scale, larger, units):
    [line] = warned(scale)
    assert f"{larger} extends" in line
    assert units in line


@pytest.mark.parametrize("scale", [0.0, 1.0, 2.8, 1 / 2.8, 8.5, 11.5, 15.0, 600.0])
def test_a_walk_that_slips_or_a_factor_of_no_unit_draws_no_question(scale):
    assert warned(scale) == ()
