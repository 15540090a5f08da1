# SPDX-License-Identifier: MIT
"""The search finds one curve from any start, and is hardly moved by a spoilt run."""

from dataclasses import replace

import numpy as np
import pytest

from model.errors import FitError
from model.slip import MagicFormula
from support.plain_samples import fitted_plainly, set_points


def test_a_spoilt_run_hardly_moves_the_fit():
    samples = set_points()
    spoilt = samples.traction_force + 2.0 * (samples.run == 20)
    assert fitted_plainly(replace(samples, traction_force=spoilt)).values[2] == pytest.approx(
        0.4, rel=0.03
    )


def test_other_starts_lead_to_the_same_fit():
    first, second = (fitted_plainly(set_points(noise=0.1), seed=seed).values for seed in (1, 2))
    np.testing.assert_allclose(first, second, rtol=1e-3)


def test_loads_at_which_no_curve_is_valid_are_refused(monkeypatch):
    monkeypatch.setattr(MagicFormula, "valid", lambda *_: np.array(False))
    with pytest.raises(FitError, match="check the unit of the load"):
        fitted_plainly(set_points())
