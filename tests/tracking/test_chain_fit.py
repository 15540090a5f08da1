# SPDX-License-Identifier: MIT
"""Shared errors and neighbouring poses come out as by least squares of the whole matrix."""

import numpy as np

from tracking.chain_fit import SharedInput
from tracking.constant_twist import Process
from tracking.smooth import smooth


def test_shared_errors_are_estimated_as_by_dense_least_squares():
    """The arrow of normal equations has the solution of the whole matrix."""
    rng, n = np.random.default_rng(5), 12
    t, q = np.arange(float(n)), 3
    poses = np.column_stack((0.1 * t, np.zeros(n), np.zeros(n))) + rng.normal(0, 1e-3, (n, 3))
    cov = np.tile(np.diag([1e-6, 2e-6, 1e-6]), (n, 1, 1))
    by_error = 1e-3 * rng.normal(size=(n, 3, q))
    told = SharedInput(by_error, 0.5 * np.eye(q), np.array([0.3, 0.0, -0.2]))
    process = Process(1e-7, 1e-7)
    joint = smooth(t, poses, covariance=cov, process=process, shared=told)
    alone = smooth(t, poses, covariance=cov, process=process)

    # For an error of each kind alone the path moves by the derivative that is returned.
    gain = joint.gain(by_error)
    for k in range(q):
        size = 0.5 * np.eye(q)[k]
        moved = smooth(t, poses + by_error @ size, covariance=cov, process=process).poses
        np.testing.assert_allclose(moved - alone.poses, gain @ size, atol=2e-6)
    np.testing.assert_allclose(joint.poses - alone.poses, gain @ joint.shared, atol=1e-5)
    spread = alone.covariance + gain @ joint.shared_covariance @ gain.transpose(0, 2, 1)
    np.testing.assert_allclose(joint.covariance, spread, rtol=1e-2, atol=1e-10)


def test_neighbours_covariance_is_that_of_a_dense_inverse():
    t = np.arange(5.0)
    poses = np.column_stack((0.1 * t, 0 * t, 0.02 * t))
    path = smooth(t, poses, covariance=np.tile(1e-6 * np.eye(3), (5, 1, 1)),
                  process=Process(1e-6, 1e-6))  # fmt: skip
    joint = np.block([[path.own[1], path.following[1]], [path.following[1].T, path.own[2]]])
    assert np.linalg.eigvalsh(joint).min() > 0
