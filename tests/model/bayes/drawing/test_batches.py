# SPDX-License-Identifier: MIT
import threading

import numpy as np
import pytest

from model.bayes.drawing.batches import LARGE, MANY, SMALL, in_batches


def log_density(z):
    return -0.5 * np.sum(z**2, axis=1)


@pytest.mark.parametrize("n", [1, SMALL, SMALL + 1, 3 * SMALL, MANY - 1, MANY, MANY + LARGE + 1])
@pytest.mark.parametrize("threads", [1, 2, 5])
def test_every_point_has_its_own_density(n, threads):
    z = np.random.default_rng(n).standard_normal((n, 3))
    np.testing.assert_array_equal(in_batches(log_density, threads)(z), log_density(z))


def test_batches_do_not_depend_on_threads_and_run_beside_each_other():
    sizes = {}
    for threads in (1, 2):
        met, seen = threading.Barrier(threads, timeout=10), []

        def density(z, met=met, seen=seen):
            met.wait()  # would never end if a batch waited for another
            seen.append(len(z))
            return log_density(z)

        in_batches(density, threads)(np.zeros((4 * SMALL, 2)))
        sizes[threads] = sorted(seen)
    assert sizes[1] == sizes[2] == [SMALL] * 4


def test_an_error_in_one_batch_is_raised():
    def refuses(z):
        if z.max() > 0:
            raise ValueError("no")
        return log_density(z)

    with pytest.raises(ValueError, match="no"):
        in_batches(refuses, 2)(np.arange(-60.0, 4.0)[:, None])
