# SPDX-License-Identifier: MIT
"""Rigs of other laboratories, calibrated through column maps; draws come from the second engine."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import chi2

from benchmarks.accuracy.tyre_bench import COLUMNS as TYRE
from model.bayes.checks.causes import Question
from model.bayes.cross_validation import r_squared
from model.bayes.drawing.convergence import Convergence
from model.bayes.drawing.laplace import find_mode
from model.bayes.drawing.weighted import importance_draws
from model.bayes.estimate import Agreement
from model.bayes.fit import PreparedFit, prepare_fit, scaled_load_cell
from model.bayes.residuals import Residuals, analyse_residuals
from model.bayes.verdict import Verdict, judge
from model.slip.magic_formula import MagicFormula
from model.slip.rig_errors import USUAL, RigErrors
from zebro_lab.calibration.rig_data import RigData, read_rig_data

pytestmark = pytest.mark.reference

SAND = """
source = "real"
columns.normal_force = { name = "avg_Fz", unit = "N", sign = -1 }
columns.traction_force = { name = "avg_Fy", unit = "N", sign = -1 }
columns.slip_ratio = { name = "slip", definition = "larger" }
runs.each_row = true
rows.keep = ["beta == 0", "slip > 0.05"]
"""
SIMULATED_RIG = """
source = "sim:virtual-world"
columns.normal_force = "Fn"
columns.traction_force = "Ft"
columns.omega_leg = "omega_l"
columns.omega_ground = "omega_g"
constants = { radius_leg = "35 mm", radius_ground = "120 mm" }
runs.by = ["Fn_set", "kappa_set"]
"""
FREE = MagicFormula("constant")
CONVERGED = Convergence(0, 1000, *([np.ones(1)] * 2), *([np.full(1, 5e3)] * 2), np.full(1, 0.01))


@dataclass(frozen=True)
class Judged:
    """A fit with everything but the sampler behind it."""

    data: RigData
    fit: PreparedFit
    draws: dict[str, np.ndarray]
    residuals: Residuals
    verdict: Verdict

    @property
    def left_out_r_squared(self) -> float:
        validation, samples = self.fit.cross_validation, self.data.samples
        assert validation is not None
        return r_squared(
            samples.traction_force, validation.predict(samples, self.fit.posterior.law)
        )


def judged(data: RigData, law: MagicFormula, rig_errors: RigErrors = USUAL) -> Judged:
    rng = np.random.default_rng(1)
    cell = scaled_load_cell(data.samples, data.load_cell)
    fit = prepare_fit(data.samples, law, load_cell=cell, rig_errors=rig_errors, rng=rng)
    posterior = fit.posterior
    weighted = importance_draws(posterior.log_density, fit.approximation, n=1000, rng=rng)
    z = weighted.resample(400, rng=rng)
    values = posterior.values(z)
    residuals = analyse_residuals(posterior.blocks, law, values)
    names = [parameter.name for parameter in posterior.free]
    verdict = judge(
        fit, data.samples, z=z, contraction=dict(zip(names, 1 - z.var(axis=0), strict=True)),
        convergence=CONVERGED,
        agreement=Agreement(mean=0.0, spread=0.0, pareto_k=weighted.pareto_k),
    )  # fmt: skip
    by_name = {p.name: values[:, i] for i, p in enumerate(posterior.parameters)}
    return Judged(data, fit, by_name, residuals, verdict)


def failed(found: Judged) -> set[str]:
    """Return the questions that are answered with no."""
    return {check.name for check in found.verdict.checks if check.failed}


@pytest.fixture
def read(tmp_path, shared) -> Callable[[str, str], RigData]:
    """Return a reader of reference data, given its place and its column map."""

    def read(place: str, columns: str) -> RigData:
        file = tmp_path / "columns.toml"
        file.write_text(columns)
        return read_rig_data([Path(shared) / place], columns=file)

    return read


def test_tyre_in_its_own_slip_is_predicted_run_by_run_and_weak_in_shape(read):
    data = read("realdata/tyre-bench/drivebrake_pure_slip.csv", TYRE)
    assert (len(data.samples), data.samples.n_runs) == (9648, 14)  # between pauses
    within_runs = np.diff(data.samples.run) == 0
    assert np.median(np.diff(data.samples.time)[within_runs]) == pytest.approx(0.01)
    assert (data.samples.normal_force > 300).all()
    found = judged(data, MagicFormula("constant"))
    assert found.fit.cross_validation is not None
    assert found.fit.cross_validation.scheme == "leave one run out, 14 runs"
    assert found.left_out_r_squared >= 0.985
    assert {"shape", "friction"} <= set(found.verdict.weak)


def test_tyre_in_slip_of_the_loaded_radius_is_corrected_by_the_radius_that_the_fit_finds(read):
    data = read("realdata/tyre-bench/drivebrake_pure_slip.csv", TYRE.replace("SL", "SR"))
    found = judged(data, MagicFormula("constant"))
    own = judged(
        read("realdata/tyre-bench/drivebrake_pure_slip.csv", TYRE), MagicFormula("constant")
    )
    found_error, own_error = (fit.draws["radius_error"].mean() for fit in (found, own))
    shift = np.median(data.samples.slip - own.data.samples.slip)
    assert found_error - own_error == pytest.approx(shift, abs=0.01)
    assert found.left_out_r_squared >= 0.98


def test_driving_wheel_in_sand_fits(read):
    data = read("realdata/single-wheel-sand/smooth.csv", SAND)
    assert len(data.samples) == data.samples.n_runs == 12  # trials of the drive side
    assert data.samples.time is None
    assert "177 of 189 rows left out; kept where beta == 0 and slip > 0.05" in data.notes
    found = judged(data, MagicFormula("constant"))
    assert found.residuals.rmse_over_load <= 0.02
    assert Question.POINTS not in failed(found)


def test_driving_and_braking_wheel_in_sand_is_called_a_bad_fit(read):
    columns = SAND.replace(', "slip > 0.05"', "")
    data = read("realdata/single-wheel-sand/smooth.csv", columns)
    assert np.ptp(data.samples.slip) == pytest.approx(1.9, abs=0.01)
    found = judged(data, MagicFormula("constant"))
    assert {Question.RAW, Question.UNITS} <= failed(found)


def test_simulated_rig_is_80_runs_and_its_slip_the_one_it_states(read, shared):
    data = read("virtual-world/rig", SIMULATED_RIG)
    assert (len(data.samples), data.samples.n_runs) == (320_000, 80)
    files = sorted((Path(shared) / "virtual-world/rig").glob("*.csv.gz"))
    stated = np.concatenate([pd.read_csv(file).kappa_inst for file in files])
    np.testing.assert_allclose(data.samples.slip, stated, atol=2e-5)


@pytest.mark.parametrize("curvature", [pytest.param(0.0, marks=pytest.mark.long), "constant"])
def test_virtual_rig_gives_back_its_law_where_its_radii_and_rolling_are_known(read, curvature):
    known = RigErrors(1e-5, 1e-4, 1e-4)
    found = judged(read("virtual-world/rig", SIMULATED_RIG), MagicFormula(curvature), known)
    K, C, mu = (found.draws[name].mean() for name in ("slip_stiffness", "shape", "friction"))
    assert pytest.approx(1.564, abs=0.02) == C
    assert pytest.approx(0.38, rel=0.02) == mu
    assert K / (C * mu) == pytest.approx(34.34, rel=0.15)
    assert "shape" not in found.verdict.weak


def test_virtual_rig_has_no_fault_but_slips_far_apart_and_the_truth_near_its_mode(read):
    found = judged(read("virtual-world/rig", SIMULATED_RIG), FREE)
    assert "the rise (too few slips)" in found.verdict.untested
    assert failed(found) <= {Question.SLIP}  # beyond chance of one in 500, in data without a fault
    # Slip of one sign: friction and rolling resistance are known together only.
    posterior = (fit := found.fit).posterior
    truth = {"slip_stiffness": 34.34 * 1.564 * 0.38, "shape": 1.564, "friction": 0.38,
             "curvature": 0.0, "radius_error": 0.0, "rolling_resistance": 0.0}  # fmt: skip
    best = dict(zip((p.name for p in posterior.parameters),
                    posterior.values(fit.laplace.mode[None])[0], strict=True))  # fmt: skip
    held = replace(posterior, fixed={**posterior.fixed, **truth}, shear=None)
    rest = find_mode(held.log_density, held.coordinates(best)[None]).mode
    values = dict(zip(best, held.values(rest[None])[0], strict=True))
    (there,) = posterior.log_density(posterior.coordinates(values)[None])
    assert 2 * (fit.laplace.log_density - there) < chi2.ppf(0.99, len(truth))
