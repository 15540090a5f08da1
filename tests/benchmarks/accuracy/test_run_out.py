# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.accuracy import run_out
from model.bayes.checks.faults import SWING_P
from support.out_of_true import swept


# ArviZ's quantiles of the weights' tail overflow where a fit is as wrong as the blind one.
@pytest.mark.filterwarnings("ignore:overflow encountered in expm1:RuntimeWarning")
@pytest.mark.timeout(300)
def test_residuals_swing_and_stiffness_is_wrong_only_while_angles_are_not_used():
    samples = swept(2e-4, 2e-4, seed=4).samples
    sweep, errors, found = run_out.corrected(samples, 0)
    assert found.used
    whole = run_out.fit(sweep, errors)
    blind = run_out.fit(replace(samples, angles=None), run_out.ERRORS)
    assert blind.swing < SWING_P < whole.swing
    assert abs(whole.error[0]) < 2.5 < abs(blind.error[0])


def test_true_coefficients_are_those_of_the_recorded_angles():
    samples, truth = run_out.simulate(0, true=False)
    assert samples.angles.leg.min() >= -np.pi
    assert truth.shape == (8,)
    assert np.all(run_out.simulate(0, true=True)[1] == 0)
