# SPDX-License-Identifier: MIT
"""Coverage of fits of simulated sweeps whose radii are wrong and whose discs resist rolling.

python -m benchmarks.accuracy.rig_errors [SEEDS] [--one-sided] [--everything]

Each seed is a rig of its own: load cell, radii and rolling resistance are drawn from the priors.
Slips go from -0.5 to 0.5, or with --one-sided from 0 to 1 as in the bundled sweep. Each sweep is
fitted, by importance weighted draws of the Laplace approximation, with the two terms and without.
With --everything the rig has more errors, which both fits have to bear: both discs run out of
true by 0.05 mm, forces are read 3 ms late or early (standard deviation), speeds are read with
an error that makes 0.01 of slip, and slip itself wanders by 0.01 within 50 ms. A third fit is told
what the first has to find out: run-out and delay are taken from the data, and the errors of slip
have their size.
Prints for each parameter how many 90 % intervals hold the truth, with the exact binomial 99 %
interval of that count, the mean error in posterior standard deviations and the interval's half
width.
"""

import copy
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing import get_context

import numpy as np
from scipy.stats import binom

from model.bayes.fit import prepare_fit
from model.bayes.laplace import LaplaceMixture, find_mode
from model.bayes.posterior import SlipPosterior
from model.bayes.rig_errors import (
    RADIUS_TOLERANCE,
    ROLLING_RESISTANCE,
    RigErrors,
    radius_ratio_sd,
)
from model.bayes.weighted import weighted_draws
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import RigImperfections, draw_imperfections
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from zebro_lab.study.layout import TWIN_CELL

LAW_NAMES = tuple(parameter.name for parameter in THESIS_LAW.parameters)
TERMS = ("radius_error", "rolling_resistance")
WITH, WITHOUT, TOLD = "with both terms", "without them", "told run-out, delay and errors of slip"
SLIPS = {True: np.linspace(0.0, 1.0, 62), False: np.linspace(-0.5, 0.5, 62)}
RUN_OUT = 5e-5  # of both discs [m]
DELAY_SD = 0.003  # of the forces [s]
SLIP_NOISE = 0.01  # of the measured slip, and wander of the true one [-]
WANDER_TIME = 0.05  # [s]
N_DRAWS = 2000
RESAMPLED = 8000


@dataclass(frozen=True)
class Intervals:
    """90 % intervals of one fit, by the parameter's name.

    Attributes:
        held: Whether the interval holds the truth.
        score: Posterior mean less the truth over the posterior standard deviation [-].
        half: Half width, in the parameter's unit.
    """

    held: dict[str, bool]
    score: dict[str, float]
    half: dict[str, float]


def with_everything(
    rig: RigImperfections, plan: SweepPlan, rng: np.random.Generator
) -> RigImperfections:
    """Add run-out, a delay, noise of the speeds and wander of slip to a rig."""
    omega_ground = plan.speed_leg / plan.radius_ground
    noise = SLIP_NOISE / np.hypot(1 / plan.omega_leg, 1 / omega_ground)
    return replace(
        rig, run_out_leg=RUN_OUT, run_out_ground=RUN_OUT, delay=rng.normal(0.0, DELAY_SD),
        speed_noise=float(noise), slip_wander_sd=SLIP_NOISE, slip_wander_time=WANDER_TIME,
    )  # fmt: skip


def fit_seed(
    seed: int, *, one_sided: bool, everything: bool = False, duration: float = 1.0
) -> dict[str, Intervals]:
    """Simulate one rig's sweep; return the intervals of its fits, by `WITH`, `WITHOUT` and `TOLD`.

    Args:
        seed: Seed of the rig and of its sweep.
        one_sided: Whether slips go from 0 to 1 instead of -0.5 to 0.5.
        everything: Whether the rig runs out of true, reads late, and its slip wanders, too.
        duration: Time at each set-point [s].
    """
    plan = SweepPlan(slips=tuple(SLIPS[one_sided].tolist()), duration=duration)
    rng = np.random.default_rng([17, seed])
    errors = RigErrors(
        radius_ratio_sd(plan.radius_leg, plan.radius_ground, RADIUS_TOLERANCE), ROLLING_RESISTANCE
    )
    rig = draw_imperfections(rng, errors)
    if everything:
        rig = with_everything(rig, plan, rng)
    same = copy.deepcopy(rng)
    simulate = partial(simulate_sweep, THESIS_LAW, THESIS_VALUES, plan=plan)
    prepare = partial(
        prepare_fit, law=THESIS_LAW, load_cell=TWIN_CELL, rig_errors=errors, validate=False
    )
    fit = prepare(simulate(imperfections=rig, rng=rng).samples, rng=rng)
    posterior = fit.posterior
    truth = dict(zip(LAW_NAMES, map(float, THESIS_VALUES), strict=True))
    truth |= {name: getattr(rig, name) for name in TERMS}
    found = {WITH: _intervals(posterior, fit.approximation, truth, rng)}
    values = posterior.values(fit.laplace.mode[None])[0]
    start = dict(zip((p.name for p in posterior.parameters), map(float, values), strict=True))
    held = {**posterior.fixed, **dict.fromkeys(TERMS, 0.0)}
    found[WITHOUT] = _from(
        replace(posterior, fixed=held, shear=None), start,
        {name: truth[name] for name in LAW_NAMES}, rng,
    )  # fmt: skip
    if everything:
        known = replace(rig, run_out_leg=0.0, run_out_ground=0.0, delay=0.0)
        told = prepare(simulate(imperfections=known, rng=same).samples, rng=rng).posterior
        sizes = {"slip_error_scale": 1.0, "slip_scatter": 0.0}
        told = replace(told, fixed={**told.fixed, **sizes}, shear=None)
        found[TOLD] = _from(told, start, truth, rng)
    return found


def _from(
    posterior: SlipPosterior,
    start: dict[str, float],
    truth: dict[str, float],
    rng: np.random.Generator,
) -> Intervals:
    """Compute the intervals of a posterior whose mode lies near parameter values."""
    mode = find_mode(posterior.log_density, posterior.coordinates(start)[None])
    return _intervals(posterior, LaplaceMixture((mode,)), truth, rng)


def _intervals(
    posterior: SlipPosterior,
    modes: LaplaceMixture,
    truth: dict[str, float],
    rng: np.random.Generator,
) -> Intervals:
    """Compute the intervals of the parameters in `truth` by importance weighted draws."""
    weighted = weighted_draws(posterior.log_density, modes, n=N_DRAWS, rng=rng)
    names = [parameter.name for parameter in posterior.parameters]
    values = posterior.values(weighted.resample(RESAMPLED, rng=rng))
    held, score, half = {}, {}, {}
    for name, true in truth.items():
        draws = values[:, names.index(name)]
        low, high = np.quantile(draws, [0.05, 0.95])
        held[name] = bool(low < true < high)
        score[name] = float((draws.mean() - true) / draws.std())
        half[name] = float(high - low) / 2
    return Intervals(held, score, half)


def table(fits: list[Intervals]) -> list[str]:
    """Format one row a parameter: its count, mean score, and mean half width."""
    rows = []
    for name in fits[0].held:
        held = sum(fit.held[name] for fit in fits)
        bias = float(np.mean([fit.score[name] for fit in fits]))
        half = float(np.mean([fit.half[name] for fit in fits]))
        rows.append(f"| {name} | {held} of {len(fits)} | {bias:+.2f} | {half:.5g} |")
    return rows


def main(seeds: int, *, one_sided: bool, everything: bool = False) -> None:
    """Print a table of each fit, and how much wider the first is than one that is told."""
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        fits = list(
            pool.map(partial(fit_seed, one_sided=one_sided, everything=everything), range(seeds))
        )
    low, high = (int(x) for x in binom.interval(0.99, seeds, 0.9))
    print(f"exact binomial 99 % interval of a count: {low} to {high} of {seeds}")
    for title in fits[0]:
        print(f"\n| {title} | 90 % intervals that hold | mean error (sd) | half width |")
        print("|---|---:|---:|---:|")
        print("\n".join(table([fit[title] for fit in fits])), flush=True)
    if TOLD in fits[0]:
        print("\nmedian half width over that of the fit that is told:")
        for name in fits[0][TOLD].half:
            ratio = np.median([fit[WITH].half[name] / fit[TOLD].half[name] for fit in fits])
            print(f"{name} {ratio:.2f}")


if __name__ == "__main__":
    given = [word for word in sys.argv[1:] if not word.startswith("--")]
    main(
        int(given[0]) if given else 200,
        one_sided="--one-sided" in sys.argv,
        everything="--everything" in sys.argv,
    )
