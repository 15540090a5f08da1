# SPDX-License-Identifier: MIT
"""Shared errors keep their covariance, by cause."""

import numpy as np

from tracking.shared import SharedErrors

BOTH = SharedErrors(np.array([[4.0, 1.0, 0.5], [1.0, 2.0, 0.2], [0.5, 0.2, 1.0]]),
                    {"a": slice(0, 2), "b": slice(2, 3)})  # fmt: skip


def test_a_new_cause_is_independent_of_the_others():
    more = BOTH.also("c", np.array([[9.0]]))
    np.testing.assert_allclose(more.covariance[:3, :3], BOTH.covariance)
    np.testing.assert_allclose(more.covariance[3], [0, 0, 0, 9.0])
    assert more.slots["c"] == slice(3, 4)


def test_the_root_gives_the_covariance_back_without_exact_values():
    exact = BOTH.also("exact", np.zeros((2, 2)))
    assert exact.root.shape == (5, 3)
    np.testing.assert_allclose(exact.root @ exact.root.T, exact.covariance, atol=1e-12)


def test_a_known_cause_takes_its_share_of_the_others():
    """The conditional covariance is the inverse of the others' block of the precision."""
    left = BOTH.given("b")
    np.testing.assert_allclose(left[2], 0, atol=1e-12)
    precision = np.linalg.inv(BOTH.covariance)
    np.testing.assert_allclose(left[:2, :2], np.linalg.inv(precision[:2, :2]), atol=1e-12)


def test_causes_that_are_not_shared_are_left_out():
    columns = BOTH.columns({"b": np.array([[3.0]]), "unknown": np.ones((1, 4))}, 1)
    np.testing.assert_allclose(columns, [[0, 0, 3.0]])
