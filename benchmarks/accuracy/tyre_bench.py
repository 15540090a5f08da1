# SPDX-License-Identifier: MIT
"""Fit a real tyre bench: which law and terms are chosen, and do they describe each load and side?

python -m benchmarks.accuracy.tyre_bench TABLE

TABLE is drivebrake_pure_slip.csv of the reference data: the pure-slip extract of a tyre bench, of
whose 14 runs the 6 at 80 to 86 kPa are read. Prints, for the plain Magic Formula, the same with the
errors of the rig, and the law that is chosen as by `--law compare` and then `--sides auto`: R² of
samples of left-out runs, and the chi-square of the mean residuals of all loads and sides. A group's
standard deviation is made of the variance between runs, over all groups, and that of block means
within runs, whatever the model says of noise. Beside them stands scipy's least-squares fit of all
samples, with and without shifts of slip and of force over load. The last column is the verdict's
own check of the groups.
"""

import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import chdtrc

from model.arrays import Array
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.bayes.checks.groups import groups
from model.bayes.checks.linear import linearise
from model.bayes.cross_validation import r_squared
from model.bayes.drawing.importance import Effort, draws_at_modes
from model.bayes.fit import PreparedFit, prepare_fit, scaled_load_cell, validated
from model.bayes.law_scores import choose_law, compare, load_groups, score_laws, weigh_law
from model.bayes.likelihood import predict_blocks
from model.bayes.preliminary import BlockChoice
from model.slip.law import SlipLaw
from model.slip.magic_formula import MagicFormula, magic_formula
from model.slip.rig_errors import RigErrors
from model.slip.sided import SidedLaw
from zebro_lab.calibration.candidates import candidates
from zebro_lab.calibration.law_table import sentence
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.workers import WorkersRequest, open_executor

COLUMNS = """
source = "real"
columns.t = { name = "ET", unit = "s" }
columns.normal_force = { name = "FZ", unit = "N", sign = -1 }
columns.traction_force = { name = "FX", unit = "N" }
columns.slip_ratio = { name = "SL", definition = "travel" }
runs.gap = "1 s"
"""
ONE_PRESSURE = 'rows.keep = ["P > 80", "P < 86"]\n'
NO_ERRORS = RigErrors(1e-9, 1e-9, 1e-9)
N_DRAWS = 2000
RESAMPLED = 300


@dataclass(frozen=True)
class Groups:
    """Mean residuals of each load and side; shape (m,) each.

    Attributes:
        load: Load level [N].
        driving: Whether slips are positive.
        mean: Mean of measured minus predicted traction of the group's blocks [N].
        sd: Its standard deviation by the scatter of runs and of blocks [N].
    """

    load: Array
    driving: NDArray[np.bool_]
    mean: Array
    sd: Array

    @property
    def square(self) -> float:
        """Chi-square of all means together [-]."""
        return float(np.sum((self.mean / self.sd) ** 2))

    @property
    def p(self) -> float:
        """Probability of a chi-square as large, if all means are zero [-]."""
        return float(chdtrc(len(self.mean), self.square))


def group_means(
    residual: Array, slip: Array, load: Array, run: NDArray[np.intp], levels: Array
) -> Groups:
    """Compute mean residuals by load and side, and their standard deviations from the scatter.

    The means of a group's runs scatter by the variance between runs, pooled over all groups of two
    runs or more, on top of that of block means within runs, pooled over all.

    Args:
        residual: Residual of each block, shape (n,) [N].
        slip: Slip ratio of each block, shape (n,) [-].
        load: Load of each block, shape (n,) [N].
        run: Run of each block, shape (n,).
        levels: Loads that were set, shape (m,) [N].
    """
    group = 2 * nearest_level(load, levels) + (slip > 0)
    cells, cell = np.unique(np.stack([group, run]), axis=1, return_inverse=True)
    cell, count = cell.ravel(), np.bincount(cell.ravel())
    mean = np.bincount(cell, residual) / count
    within = float(np.sum((residual - mean[cell]) ** 2) / max(len(residual) - len(count), 1))
    names, of_group = np.unique(cells[0], return_inverse=True)
    n_runs = np.bincount(of_group)
    plain = np.bincount(of_group, mean) / n_runs
    scatter = float(np.sum((mean - plain[of_group]) ** 2))
    by_chance = float(np.sum(within / count * (1 - 1 / n_runs[of_group])))
    between = max(0.0, (scatter - by_chance) / max(len(mean) - len(names), 1))
    share = count / np.bincount(of_group, count)[of_group].astype(float)
    return Groups(
        levels[names // 2],
        names % 2 == 1,
        np.bincount(of_group, share * mean).astype(float),
        np.sqrt(np.bincount(of_group, share**2 * (between + within / count))),
    )


def least_squares_fit(slip: Array, load: Array, force: Array, *, shifts: bool) -> Array:
    """Fit a Magic Formula to samples by scipy's least squares; return its residuals (n,) [N].

    D is proportional to load; B, C and E are the same at every load.

    Args:
        slip: Slip ratios, shape (n,) [-].
        load: Normal force, shape (n,) [N].
        force: Traction force, shape (n,) [N].
        shifts: Whether slip is shifted, and force by a share of the load.
    """

    def residual(x: Array) -> Array:
        B, C, mu, E, s_h, s_v = x if shifts else np.append(x, [0.0, 0.0])
        return force - magic_formula(slip + s_h, B, C, mu * load, E) - s_v * load

    start = [15.0, 1.5, 1.2, 0.0, *([0.0, 0.0] if shifts else [])]
    return residual(least_squares(residual, start, x_scale=np.maximum(np.abs(start), 0.1)).x)


def read(table: Path) -> RigData:
    """Read the bench's samples of one pressure."""
    with tempfile.TemporaryDirectory() as folder:
        columns = Path(folder) / "columns.toml"
        columns.write_text(COLUMNS + ONE_PRESSURE)
        return read_rig_data([table], columns=columns)


def _fit(data: RigData, law: SlipLaw, errors: RigErrors, choice: BlockChoice | None) -> PreparedFit:
    cell = scaled_load_cell(data.samples, data.load_cell)
    rng = np.random.default_rng(1)
    return prepare_fit(
        data.samples, law, load_cell=cell, rng=rng, rig_errors=errors, block_choice=choice,
        validate=False,
    )  # fmt: skip


def chosen(data: RigData, choice: BlockChoice) -> tuple[str, PreparedFit]:
    """Return the fit of the law that `--law compare` and then `--sides auto` choose, and why."""
    laws = candidates(CalibrationRequest(law="compare"), data.samples)
    fits = {name: _fit(data, law, data.rig_errors, choice) for name, law in laws.items()}
    rng = np.random.default_rng(2)
    weighed = [weigh_law(name, fit, rng=rng) for name, fit in fits.items()]
    with open_executor(WorkersRequest()) as executor:
        scores = score_laws(weighed, executor=executor)
    found = choose_law(scores, load_groups(next(iter(fits.values())).posterior.blocks)[1])
    best = validated(fits[found.laws[found.chosen].name])
    apart = validated(_fit(data, SidedLaw(best.posterior.law), data.rig_errors, choice))
    sides = compare(["together", "apart"], [best, apart])
    said = f"{sentence(found)} Sides {sides.names[sides.chosen]}."
    return said, (best, apart)[sides.chosen]


def judged(name: str, data: RigData, fit: PreparedFit) -> str:
    """Return a line of the table: R², chi-square of the groups, and the verdict's own check."""
    posterior, rng = fit.posterior, np.random.default_rng(3)
    weighted = draws_at_modes(fit.modes, posterior.log_density, effort=Effort(N_DRAWS), rng=rng)
    z = weighted.resample(RESAMPLED, rng=rng)
    blocks = posterior.blocks
    force = predict_blocks(blocks, posterior.law, posterior.values(z)).force.mean(axis=0)
    found = group_means(
        blocks.traction_force - force, blocks.slip, blocks.normal_force, blocks.run,
        load_levels(blocks),
    )  # fmt: skip
    validation = validated(fit).cross_validation
    score = np.nan
    if validation is not None:
        measured = data.samples.traction_force
        score = r_squared(measured, validation.predict(data.samples, posterior.law))
    check = groups(linearise(posterior, z), None)
    return (
        f"{name:28s} {score:8.5f} {found.square:7.1f} of {len(found.mean)} {found.p:8.2g}   "
        f"{check.outcome.name.lower()}"
    )


def scipy_line(name: str, data: RigData, fit: PreparedFit, *, shifts: bool) -> str:
    """Return a line of the table for scipy's fit, its residuals averaged over the fit's blocks."""
    samples, blocks = data.samples, fit.posterior.blocks
    residual = least_squares_fit(
        samples.slip, samples.normal_force, samples.traction_force, shifts=shifts
    )
    starts = np.concatenate([[0], np.cumsum(blocks.count)[:-1]])
    means = np.add.reduceat(residual, starts) / blocks.count
    found = group_means(means, blocks.slip, blocks.normal_force, blocks.run, load_levels(blocks))
    rms = float(np.sqrt(np.mean(residual**2)))
    return (
        f"{name:28s} {'':8s} {found.square:7.1f} of {len(found.mean)} {found.p:8.2g}   "
        f"rms {rms:.0f} N"
    )


def main(arguments: Sequence[str]) -> None:
    """Print the table for the arguments of the command line."""
    data = read(Path(arguments[0]))
    print("\n".join(data.notes))
    plain = _fit(data, MagicFormula("constant"), NO_ERRORS, None)
    said, best = chosen(data, plain.block_choice)
    errors = _fit(data, MagicFormula("constant"), data.rig_errors, plain.block_choice)
    print(said)
    print(f"{'':28s} {'R² left':>8s} {'chi²':>12s} {'p':>8s}   verdict's own check")
    print(judged("plain law", data, plain), flush=True)
    print(judged("with errors of the rig", data, errors), flush=True)
    print(judged("chosen", data, best))
    print(scipy_line("scipy", data, plain, shifts=False))
    print(scipy_line("scipy, with shifts", data, plain, shifts=True))


if __name__ == "__main__":
    main(sys.argv[1:])
