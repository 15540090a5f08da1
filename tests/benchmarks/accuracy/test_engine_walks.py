# SPDX-License-Identifier: MIT
from benchmarks.accuracy import engine_walks


def test_every_model_is_compared_with_the_engine(one_walk, rows):
    engine_walks.main()
    first, bend = rows()
    errors = [float(cell.split()[0]) for cell in first[1:]]
    assert (first[0], bend[0]) == (one_walk, one_walk)
    assert errors[0] < 2.0  # [%] of our own model
    assert errors[0] < min(errors[2:])
