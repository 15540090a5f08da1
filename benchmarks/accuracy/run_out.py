# SPDX-License-Identifier: MIT
"""Coverage of run-out by angle, and of fits of sweeps with discs out of true.

python -m benchmarks.accuracy.run_out [SEEDS] [--true]

Each seed is a rig of its own with the bundled plan in runs of half a second, whose coefficients of
run-out, both harmonics of both discs, are drawn from their prior of 0.05 mm; with --true its discs
run true. Each sweep is fitted, by importance weighted draws of the Laplace approximation, with the
angles and without. Prints how many 90 % intervals hold the truth, the mean error in posterior
standard deviations, the mean half width, and in how many fits residuals swing as discs turn.
"""

import sys
from dataclasses import dataclass, replace

import numpy as np

from model.bayes.checks.faults import SWING_P
from model.bayes.checks.linear import linearise
from model.bayes.checks.periodic import block_times, find_swing
from model.bayes.fit import prepare_fit
from model.bayes.rig_errors import RUN_OUT, RigErrors, radius_ratio_sd, run_out_scatter
from model.bayes.run_out import RunOut, find_run_out, without_run_out
from model.bayes.samples import SlipSamples
from model.bayes.weighted import weighted_draws
from model.slip.law import Array
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import draw_imperfections
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from zebro_lab.study.layout import TWIN_CELL

PLAN = SweepPlan(duration=0.5)
RADII = PLAN.radius_leg, PLAN.radius_ground
ERRORS = RigErrors(radius_ratio_sd(*RADII, 2e-5), 0.002, run_out_scatter(*RADII, RUN_OUT), RUN_OUT)
NAMES = ("slip_stiffness", "friction")


@dataclass(frozen=True)
class Fitted:
    """One fit: error and half width of the interval of each of `NAMES`, and the swing's p-value.

    Attributes:
        error: Posterior mean less the truth, in posterior standard deviations, shape (2,) [-].
        held: Whether the 90 % interval holds the truth, shape (2,).
        half: Its half width, shape (2,), in the parameter's unit.
        mean: Posterior mean, shape (2,), in the parameter's unit.
        swing: Probability of a swing as large by chance [-].
    """

    error: Array
    held: Array
    half: Array
    mean: Array
    swing: float


def simulate(seed: int, *, true: bool) -> tuple[SlipSamples, Array]:
    """Simulate one rig's sweep; return it with the true coefficients by disc, shape (8,) [m]."""
    rng = np.random.default_rng([54, seed])
    rig = draw_imperfections(rng, ERRORS)
    size = (0.0 if true else RUN_OUT) * np.hypot(*rng.standard_normal((2, 4)))
    rig = replace(
        rig, run_out_leg=size[0], run_out_leg_twice=size[1],
        run_out_ground=size[2], run_out_ground_twice=size[3],
    )  # fmt: skip
    sweep = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=PLAN, imperfections=rig, rng=rng, angles=True
    ).samples
    if sweep.angles is None or sweep.angles.leg is None or sweep.angles.ground is None:
        raise ValueError("the sweep has no angles")
    at = rng.uniform(0.0, 2 * np.pi, 2)  # where the encoders' zeros are
    angles = replace(
        sweep.angles,
        leg=(sweep.angles.leg + at[0] + np.pi) % (2 * np.pi) - np.pi,
        ground=sweep.angles.ground + at[1],
    )
    turned = np.repeat(at, 2) * [1, 2, 1, 2]
    truth = np.column_stack([size * np.cos(turned), size * np.sin(turned)]).ravel()
    return replace(sweep, angles=angles), truth


def corrected(samples: SlipSamples, seed: int) -> tuple[SlipSamples, RigErrors, RunOut | None]:
    """Return the sweep as `calibrate` fits it, with what remains of the rig's errors."""
    found = find_run_out(
        samples, THESIS_LAW, load_cell=TWIN_CELL, rig_errors=ERRORS, rng=np.random.default_rng(seed)
    )
    if found is None or not found.used:
        return samples, ERRORS, found
    return without_run_out(samples, found), replace(ERRORS, slip_scatter=found.scatter), found


def fit(samples: SlipSamples, errors: RigErrors) -> Fitted:
    """Fit a sweep by weighted draws."""
    rng = np.random.default_rng(1)
    prepared = prepare_fit(
        samples, THESIS_LAW, load_cell=TWIN_CELL, rig_errors=errors, rng=rng, validate=False
    )
    posterior = prepared.posterior
    draws = weighted_draws(posterior.log_density, prepared.approximation, n=2000, rng=rng)
    z = draws.resample(4000, rng=rng)
    order = [[p.name for p in posterior.parameters].index(name) for name in NAMES]
    values = posterior.values(z)[:, order]
    truth = dict(zip((p.name for p in THESIS_LAW.parameters), THESIS_VALUES, strict=True))
    true = np.array([float(truth[name]) for name in NAMES])
    low, high = np.quantile(values, [0.05, 0.95], axis=0)
    mean = values.mean(axis=0)
    linear = linearise(posterior, z)
    swing = find_swing(linear, block_times(linear, samples))
    return Fitted(
        (mean - true) / values.std(axis=0), (low < true) & (true < high), (high - low) / 2, mean,
        1.0 if swing is None else swing.p,
    )  # fmt: skip


def _row(title: str, fits: list[Fitted]) -> str:
    held, error, half = (
        np.array([getattr(each, of) for each in fits]) for of in ("held", "error", "half")
    )
    cells = [
        f"{held[:, i].sum()} of {len(fits)}, {error[:, i].mean():+.2f}, {half[:, i].mean():.3g}"
        for i in range(len(NAMES))
    ]
    swings = sum(each.swing <= SWING_P for each in fits)
    return f"| {title} | {' | '.join(cells)} | {swings} |"


def main(seeds: int, *, true: bool) -> None:
    """Print the coefficients' coverage, and both fits'."""
    scores, used, with_angles, without = [], 0, [], []
    for seed in range(seeds):
        samples, truth = simulate(seed, true=true)
        sweep, errors, found = corrected(samples, seed)
        if found is not None:
            used += found.used
            sd = np.concatenate([disc.sd for disc in found.discs])
            scores.append((found.coefficients - truth) / sd)
        with_angles.append(fit(sweep, errors))
        without.append(fit(replace(samples, angles=None), ERRORS))
        moved = np.abs(with_angles[-1].mean - without[-1].mean) / without[-1].half * 1.645
        print(
            f"seed {seed}: corrected {found is not None and found.used}, moved by "
            f"{moved[0]:.2f} and {moved[1]:.2f} sd, swing p {without[-1].swing:.1g} -> "
            f"{with_angles[-1].swing:.1g}",
            flush=True,
        )
    z = np.array(scores)
    print(
        f"coefficients: {np.sum(np.abs(z) < 1.645)} of {z.size} within 90 % intervals, mean "
        f"{z.mean():+.2f}, root mean square {np.sqrt(np.mean(z**2)):.2f}; corrected {used}"
    )
    print(f"| fit | {' | '.join(NAMES)} (held, error, half width) | swings |\n|---|---|---|---:|")
    print(_row("with angles", with_angles))
    print(_row("without", without))


if __name__ == "__main__":
    given = [word for word in sys.argv[1:] if not word.startswith("--")]
    main(int(given[0]) if given else 20, true="--true" in sys.argv)
