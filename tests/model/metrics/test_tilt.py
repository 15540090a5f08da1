# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import InsufficientData
from model.metrics.tilt import tilt_errors

T = np.arange(0.0, 10.0, 0.01)


def walk(t):
    return 0.01 * np.column_stack([np.sin(3 * t), 0.5 * np.cos(5 * t)])


def test_a_bias_of_the_unit_is_told_from_errors_of_the_walk():
    at = np.arange(0.5, 9.5, 0.03)
    errors, inside = tilt_errors(T, walk(T), at, walk(at) + np.array([0.02, -0.01]))
    assert inside.all()
    np.testing.assert_allclose(errors.bias, [-0.02, 0.01], atol=1e-5)
    np.testing.assert_allclose(errors.rms, [0.02, 0.01], rtol=1e-3)
    assert np.all(errors.rms_unbiased < 1e-5)


def test_a_walk_that_does_not_rock_errs_by_the_swing():
    errors, _ = tilt_errors(T, np.zeros((len(T), 2)), T, walk(T))
    np.testing.assert_allclose(errors.rms_unbiased, errors.swing)
    np.testing.assert_allclose(errors.swing, [0.01 / np.sqrt(2), 0.005 / np.sqrt(2)], rtol=0.02)


def test_measurements_outside_the_walk_do_not_count():
    at = np.arange(-4.95, 15.0, 0.1)
    errors, inside = tilt_errors(T, walk(T), at, np.where((at < 0)[:, None], 9.0, walk(at)))
    assert errors.samples == inside.sum() == 100
    assert np.all(errors.rms < 1e-4)


def test_other_clocks_are_refused():
    with pytest.raises(InsufficientData, match="clock"):
        tilt_errors(T, walk(T), T + 100, walk(T))
