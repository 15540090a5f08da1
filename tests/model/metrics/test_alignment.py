# SPDX-License-Identifier: MIT
"""Alignment finds the motion that was made, and never a mirror image."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from model.metrics.alignment import umeyama


@pytest.mark.parametrize("scale", [1.0, 0.4])
def test_a_motion_in_space_is_found(scale):
    rng = np.random.default_rng(1)
    x, turn = rng.normal(size=(20, 3)), Rotation.from_rotvec([0.3, -1.0, 0.5]).as_matrix()
    found = umeyama(x, scale * x @ turn.T + [1, 2, 3], with_scale=True)
    assert found.scale == pytest.approx(scale)
    np.testing.assert_allclose(found.rotation, turn, atol=1e-12)
    np.testing.assert_allclose(found.translation, [1, 2, 3], atol=1e-12)


def test_a_mirror_image_stays_one_in_the_plane():
    x = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]])
    found = umeyama(x, x * [1, -1])
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)
    assert np.abs(found.apply(x) - x * [1, -1]).max() > 0.1


def test_a_path_that_stays_in_place_is_not_scaled():
    x = np.zeros((4, 3))
    found = umeyama(x, np.random.default_rng(1).normal(size=(4, 3)), with_scale=True)
    assert found.scale == 1.0
    assert np.isfinite(found.translation).all()
