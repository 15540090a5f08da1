# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.speed.calibration import LOAD_CELL, simulate
from benchmarks.speed.calibration_nuts import jax_log_density, largest_difference
from model.bayes.drawing.shear import Shear
from model.bayes.fit import prepare_fit
from model.slip.magic_formula import MagicFormula
from model.slip.thesis_curve import THESIS_LAW
from rig.slip_rig.sweep import SweepPlan

pytestmark = pytest.mark.long  # needs the group bench, which `make bench` installs
SMALL = SweepPlan(slips=(0.02, 0.05, 0.1, 0.2, 0.4, 0.8), duration=0.4)


@pytest.fixture(scope="module")
def fit():
    jax = pytest.importorskip("jax", reason="the group bench is not installed")
    jax.config.update("jax_enable_x64", True)
    return prepare_fit(
        simulate(SMALL).samples, THESIS_LAW, load_cell=LOAD_CELL, rng=np.random.default_rng(1),
        validate=False,
    )  # fmt: skip


def draws(fit, spread):
    drawn = fit.approximation.draw(40, rng=np.random.default_rng(2))
    z = fit.laplace.mode + spread * (drawn - fit.laplace.mode)
    return z[np.isfinite(fit.posterior.log_density(z))]


@pytest.mark.parametrize("spread", [1.0, 3.0])
def test_the_density_in_jax_is_ours(fit, spread):
    assert largest_difference(fit.posterior, draws(fit, spread)) < 1e-7


def test_the_density_in_jax_is_ours_in_straightened_coordinates(fit):
    d = len(fit.laplace.mode)
    shift = np.random.default_rng(3).normal(scale=0.01, size=(2, d))
    wide = np.eye(d)[:, :2]
    shear = Shear(fit.laplace.mode, wide, ((0, 1), (1, 1, 1)), shift)
    sheared = replace(fit.posterior, shear=shear)
    z = draws(fit, 1.0)
    assert np.abs(sheared.log_density(z) - fit.posterior.log_density(z)).max() > 0.01
    inside = np.isfinite(sheared.log_density(z))
    assert largest_difference(sheared, z[inside]) < 1e-7


def test_both_densities_are_zero_where_the_curve_has_no_peak(fit):
    names = [parameter.name for parameter in fit.posterior.free]
    z = fit.laplace.mode.copy()
    z[names.index("shape")], z[names.index("peak_slip_per_load")] = 4.0, 4.0
    assert np.isneginf(fit.posterior.log_density(z[None])).all()
    assert np.isneginf(float(jax_log_density(fit.posterior)(z)))


def test_a_posterior_of_another_law_is_refused(fit):
    other = replace(fit.posterior, law=MagicFormula(curvature="constant"))
    with pytest.raises(ValueError, match="thesis's law"):
        jax_log_density(other)
