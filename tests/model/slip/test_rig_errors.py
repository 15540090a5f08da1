# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.slip.rig_errors import radius_ratio_sd


def test_the_ratio_of_two_radii_is_as_uncertain_as_draws_of_them():
    rng = np.random.default_rng(3)
    leg, ground = (
        0.035 + 1e-4 * rng.standard_normal(200_000),
        0.12 + 1e-4 * rng.standard_normal(200_000),
    )
    drawn = np.std(ground / leg) / (0.12 / 0.035)
    assert radius_ratio_sd(0.035, 0.12, 1e-4) == pytest.approx(drawn, rel=0.01)
