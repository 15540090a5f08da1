# SPDX-License-Identifier: MIT
"""Fits that nothing is wrong with, as block means, draws and diagnostics, to plant one fault in."""

import numpy as np

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.drawing.convergence import Convergence
from model.bayes.estimate import Agreement
from model.slip import MagicFormula
from model.slip.definition import SlipDefinition

CONVERGED = Convergence(
    burn_in=50, length=1000, autocorrelation_time=np.full(10, 10.0), r_hat=np.full(10, 1.001),
    ess_bulk=np.full(10, 5000.0), ess_tail=np.full(10, 4000.0), mcse=np.full(10, 0.01),
)  # fmt: skip
AGREED = Agreement(mean=0.04, spread=0.02, pareto_k=0.3, mean_error=0.02, spread_error=0.01)
LAW = MagicFormula("constant")
RIG_VALUES = (34.34 * 1.564 * 0.38, 1.564, 0.38, 0.0)
WELL_INFORMED = dict.fromkeys(("slip_stiffness", "shape", "friction", "curvature"), 0.99)


def blocks_at(set_points: np.ndarray, *, loads=(6.0, 12.0), per_run: int = 6) -> SlipBlocks:
    """Make two runs of each set-point of slip at each load."""
    loads = np.repeat(loads, 2)
    slip = np.repeat(np.tile(set_points, len(loads)), per_run)
    load = np.repeat(loads, len(set_points) * per_run)
    n_runs, zeros = len(set_points) * len(loads), np.zeros(len(slip))
    return SlipBlocks(
        slip=slip, normal_force=load, traction_force=zeros,
        count=np.full(len(slip), 50), run=np.repeat(np.arange(n_runs), per_run),
        run_names=tuple("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"[:n_runs]),
        definition=SlipDefinition.MATERIAL, slip_wander=zeros, slip_error=zeros,
        load_variance=zeros, load_skewness=zeros, slip_load_covariance=zeros,
        run_slip_error=np.zeros(n_runs), load_error=zeros, noise_size=zeros + 1,
    )  # fmt: skip


def two_sided(largest_slip: float, **changes) -> SlipBlocks:
    """Make runs of driving and braking slips that lie closer together near zero."""
    half = largest_slip * np.geomspace(0.02, 1.0, 6)
    return blocks_at(np.append(-half[::-1], half), **changes)


def draws(law_values: tuple[float, ...]) -> np.ndarray:
    """Repeat one parameter vector, of a perfect load cell, as if it were draws."""
    measurement = (*(0.0,) * 6, 1.0, 0.0, 0.02, 0.01, 0.1, 0.05)
    return np.tile([*law_values, *measurement], (5, 1))
