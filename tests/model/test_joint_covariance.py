# SPDX-License-Identifier: MIT
"""The joint covariance of a track is that of a Markov chain with shared errors."""

import numpy as np
import pytest

from model.errors import DomainError
from model.joint_covariance import JointCovariance


def chain(n=6, q=2, seed=0):
    """Draw a Markov chain of 4 values, of which 3 are the pose; return it and its covariance."""
    rng = np.random.default_rng(seed)
    step = 0.3 * rng.normal(size=(n, 4, 4))
    own, following = [np.eye(4)], []
    for k in range(1, n):
        following.append(own[-1] @ step[k])
        own.append(step[k].T @ own[-1] @ step[k] + np.diag(rng.uniform(0.5, 1, 4)))
    by_error, root = rng.normal(size=(n, 3, q)), rng.normal(size=(q, q))
    joint = JointCovariance(np.array(own), np.array(following), by_error, root @ root.T)
    # The same written out: every state is a sum of the disturbances before it.
    whole = np.zeros((n, 4, n, 4))
    for a in range(n):
        across = own[a]
        whole[a, :, a] = across
        for b in range(a + 1, n):
            across = across @ step[b]
            whole[a, :, b], whole[b, :, a] = across, across.T
    flat = by_error.reshape(3 * n, q)
    dense = whole[:, :3, :, :3].reshape(3 * n, 3 * n) + flat @ root @ root.T @ flat.T
    return joint, dense


def test_the_dense_covariance_is_that_of_the_chain():
    joint, dense = chain()
    np.testing.assert_allclose(joint.dense, dense, atol=1e-12)
    np.testing.assert_allclose(joint.marginal[2], dense[6:9, 6:9], atol=1e-12)


@pytest.mark.parametrize("rows", [[0, 1, 2], [1, 4, 5], [3], [0, 5]])
def test_some_poses_have_the_covariance_they_had(rows):
    joint, dense = chain()
    kept = [3 * row + axis for row in rows for axis in range(3)]
    np.testing.assert_allclose(joint.part(np.array(rows)).dense, dense[np.ix_(kept, kept)],
                               atol=1e-12)  # fmt: skip


def test_draws_have_the_covariance():
    joint, dense = chain(n=4)
    draws = joint.draw(200_000, rng=np.random.default_rng(1)).reshape(-1, 12)
    np.testing.assert_allclose(np.cov(draws.T), dense, atol=0.02 * np.abs(dense).max())


def test_one_more_shared_error_adds_its_outer_product():
    joint, dense = chain()
    along = np.random.default_rng(2).normal(size=(6, 3))
    more = joint.also(along, 0.25).dense
    np.testing.assert_allclose(more - dense, 0.25 * np.outer(along, along), atol=1e-12)


def test_independent_poses_have_no_covariance_with_each_other():
    dense = JointCovariance.independent(np.tile(np.diag([1.0, 2.0, 3.0]), (3, 1, 1))).dense
    np.testing.assert_allclose(dense, np.diag([1.0, 2.0, 3.0] * 3))


def test_parts_that_do_not_match_are_refused():
    with pytest.raises(DomainError, match="parts of shape"):
        JointCovariance(np.zeros((3, 3, 3)), np.zeros((1, 3, 3)), np.zeros((3, 3, 0)),
                        np.zeros((0, 0)))  # fmt: skip


def test_no_poses_have_no_covariance():
    none = JointCovariance.independent(np.zeros((0, 3, 3)))
    assert none.dense.shape == (0, 0)
    assert none.marginal.shape == (0, 3, 3)
    assert none.part(slice(0, 0)).dense.shape == (0, 0)
