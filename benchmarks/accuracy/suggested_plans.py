# SPDX-License-Identifier: MIT
"""Suggested points beside even ones, on simulated rigs, at equal total time.

python -m benchmarks.accuracy.suggested_plans [SEEDS] [--walk] [--time S]

Each seed is a rig of its own: load cell, radii and rolling resistance are drawn from the priors. A
pilot of two loads and eight slips is calibrated by weighted draws, and points are suggested for the
time that is left, for slip stiffness, for traction at three slips, and with --walk for the end pose
of a walk of 10 s. The suggested sweep is fitted with the pilot. Beside it are sweeps of the whole
time, without a pilot, at the plan's four loads: slips even from 0 to 1, and spaced quadratically
towards zero. Loads are set by hand, 30 s each. Prints the median over seeds of the half width of
90 % intervals, how much narrower that of the suggestion is, seed by seed, and how many intervals
hold the truth.
"""

import json
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.stats import binom

from benchmarks.tables import print_table
from model.arrays import Array
from model.bayes.fit import prepare_fit
from model.bayes.posterior import SlipPosterior
from model.bayes.rig_errors import (
    RADIUS_TOLERANCE,
    ROLLING_RESISTANCE,
    RigErrors,
    radius_ratio_sd,
)
from model.bayes.samples import SlipSamples
from model.bayes.weighted import weighted_draws
from model.design.choose import spaced
from model.design.targets import Target, force_target, parameter_target
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.experiment.plan import Plan
from rig.slip_rig.imperfections import RigImperfections, draw_imperfections
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.study.layout import TWIN_CELL
from zebro_lab.suggest.proposal import knowledge_of, most_slips, propose, seconds_of

PLAN = Path(__file__).parents[2] / "examples" / "plan-thesis.toml"
ERRORS = RigErrors(radius_ratio_sd(0.035, 0.12, RADIUS_TOLERANCE), ROLLING_RESISTANCE)
SLIPS, LOAD = np.array([0.02, 0.05, 0.2]), 8.13
RATE = SweepPlan().rate
TIME = 400.0  # s
N_DRAWS, RESAMPLED = 2000, 4000
STIFFNESS = "slip_stiffness"
FORCES = tuple(f"force@{slip:g}:{LOAD:g}" for slip in SLIPS)
EVEN, QUADRATIC = "even", "quadratic"


def base_plan() -> Plan:
    """Return the thesis's plan with one zero and without check points."""
    plan = read_plan(PLAN)
    return replace(plan, controls=replace(plan.controls, tare_every=0, check_every=0))


def pilot_of(plan: Plan) -> Plan:
    """Return the pilot: both ends of the loads, eight slips, half a second each."""
    slips, loads = tuple(spaced(0.0, 1.0, 8).tolist()), plan.points.loads
    points = replace(plan.points, slips=slips, loads=(min(loads), max(loads)), duration=0.5)
    return replace(plan, points=points)


def filled(plan: Plan, seconds: float, slips: Callable[[int], Array]) -> Plan:
    """Return a plan with as many slips at each load as the time allows."""
    count = most_slips(plan, seconds, least=3)
    if count is None:
        raise ValueError(f"{seconds} s are too short")
    return replace(plan, points=replace(plan.points, slips=tuple(slips(count).tolist())))


def measured(plan: Plan, rig: RigImperfections, rng: np.random.Generator) -> SlipSamples:
    """Simulate the sweep of a plan."""
    points = plan.points
    swept = SweepPlan(slips=points.slips, loads=points.loads, duration=points.duration)
    return simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=swept, imperfections=rig, rng=rng).samples


def joined(one: SlipSamples, other: SlipSamples) -> SlipSamples:
    """Return the samples of two sweeps as those of one."""
    return SlipSamples(
        slip=np.concatenate([one.slip, other.slip]),
        normal_force=np.concatenate([one.normal_force, other.normal_force]),
        traction_force=np.concatenate([one.traction_force, other.traction_force]),
        run=np.concatenate([one.run, other.run + one.n_runs]),
        run_names=(*one.run_names, *other.run_names),
        definition=one.definition,
    )


def fitted(samples: SlipSamples, rng: np.random.Generator) -> tuple[SlipPosterior, Array, float]:
    """Fit samples; return the posterior, equally weighted draws of z, and Pareto k of the draws."""
    fit = prepare_fit(
        samples,
        THESIS_LAW,
        load_cell=TWIN_CELL,
        rig_errors=ERRORS,
        rng=rng,
        validate=False,
    )
    draws = weighted_draws(fit.posterior.log_density, fit.approximation, n=N_DRAWS, rng=rng)
    return fit.posterior, draws.resample(RESAMPLED, rng=rng), draws.pareto_k


def law_values(posterior: SlipPosterior, z: Array) -> Array:
    """Return the law's parameters of draws, shape (w, k)."""
    return posterior.values(z)[:, : len(THESIS_LAW.parameters)]


def quantities(values: Array) -> dict[str, Array]:
    """Return slip stiffness and the forces of law parameters (w, k), each (w,)."""
    force = THESIS_LAW.force(SLIPS, LOAD, values.T[:, :, None])
    return {STIFFNESS: values[:, 0], **dict(zip(FORCES, force.T, strict=True))}


def intervals(found: Mapping[str, Array]) -> dict[str, list[float]]:
    """Return half width, low and high end of the 90 % interval of each quantity."""
    ends = {name: np.quantile(draws, [0.05, 0.95]) for name, draws in found.items()}
    return {name: [float(high - low) / 2, float(low), float(high)]
            for name, (low, high) in ends.items()}  # fmt: skip


def follow(seed: int, seconds: float, *, walk: bool) -> dict[str, dict[str, list[float]]]:
    """Return the intervals of each plan of one seed, by plan and quantity."""
    rng = np.random.default_rng([45, seed])
    plan, rig = base_plan(), draw_imperfections(rng, ERRORS)
    first = pilot_of(plan)
    pilot = measured(first, rig, rng)
    posterior, z, _ = fitted(pilot, rng)
    plain = replace(posterior, shear=None)
    knowledge = knowledge_of(plain, posterior.prior_coordinates(z), rate=RATE)
    around = knowledge.draws
    targets: dict[str, Target] = {
        STIFFNESS: parameter_target(plain, around, STIFFNESS),
        "force": force_target(plain, around, name="force", slips=SLIPS, loads=np.array([LOAD])),
    }
    posed: Callable[[Array], Mapping[str, Array]] = _nothing
    if walk:
        from benchmarks.accuracy.suggested_walk import END_POSE, end_target, poses_of

        targets = {END_POSE: end_target(plain, posterior.prior_coordinates(z), len(around))}
        posed = poses_of
    even = filled(plan, seconds, lambda n: np.linspace(0.0, 1.0, n))
    quadratic = filled(plan, seconds, lambda n: spaced(0.0, 1.0, n))
    left = seconds - seconds_of(first)
    found: dict[str, dict[str, list[float]]] = {}
    for name, sweep in {EVEN: even, QUADRATIC: quadratic}.items():
        found[name] = _found(measured(sweep, rig, rng), rng, posed)
    for name, target in targets.items():
        proposal = propose(plan, knowledge, [target], seconds=left)
        samples = joined(pilot, measured(proposal.plan, rig, rng))
        found[name] = _found(samples, rng, posed)
    return found


def _nothing(_: Array) -> Mapping[str, Array]:
    return {}


def _found(
    samples: SlipSamples, rng: np.random.Generator, posed: Callable[[Array], Mapping[str, Array]]
) -> dict[str, list[float]]:
    posterior, z, k = fitted(samples, rng)
    values = law_values(posterior, z)
    return {**intervals({**quantities(values), **posed(values)}), "pareto_k": [k, k, k]}


def truths() -> dict[str, float]:
    """Return the true quantities."""
    values = np.array(THESIS_VALUES)[None]
    return {name: float(each[0]) for name, each in quantities(values).items()}


def rows(
    found: Sequence[Mapping[str, Mapping[str, Sequence[float]]]],
    of: Mapping[str, Sequence[str]],
    true: Mapping[str, float],
) -> list[tuple[str, ...]]:
    """Return a row for each quantity.

    Args:
        found: Intervals of each seed, by plan and quantity.
        of: Quantities that each suggestion was made for, by its name.
        true: True value of each quantity.
    """
    table = []
    for suggestion, names in of.items():
        for name in names:
            half = {p: np.array([each[p][name][0] for each in found])
                    for p in (EVEN, QUADRATIC, suggestion)}  # fmt: skip
            gains = [100 * np.median(1 - half[suggestion] / half[p]) for p in (EVEN, QUADRATIC)]
            held = [
                sum(each[p][name][1] < true[name] < each[p][name][2] for each in found)
                for p in (EVEN, QUADRATIC, suggestion)
            ]
            table.append(
                (name, *(f"{np.median(each):.4g}" for each in half.values()),
                 *(f"{gain:+.0f} %" for gain in gains), *(f"{n}" for n in held))
            )  # fmt: skip
    return table


def main(seeds: int, seconds: float, *, walk: bool) -> None:
    """Print the table."""
    found, true = [], truths()
    of: Mapping[str, Sequence[str]] = {STIFFNESS: (STIFFNESS,), "force": FORCES}
    if walk:
        from benchmarks.accuracy.suggested_walk import END_POSE, PARTS, true_pose

        of, true = {END_POSE: PARTS}, {**true, **true_pose()}
    for seed in range(seeds):
        began = time.monotonic()
        found.append(follow(seed, seconds, walk=walk))
        line = {"seed": seed, "took_s": round(time.monotonic() - began), **found[-1]}
        print(json.dumps(line), file=sys.stderr, flush=True)
    low, high = (int(x) for x in binom.interval(0.99, seeds, 0.9))
    print(f"{seeds} rigs, {seconds:g} s each; exact binomial 99 % of a count: {low} to {high}\n")
    head = ("quantity", "half width: even", "quadratic", "suggested", "narrower than even",
            "than quadratic", "held: even", "quadratic", "suggested")  # fmt: skip
    print_table(head, *rows(found, of, true))


if __name__ == "__main__":
    given = sys.argv[1:]
    budget = TIME
    if "--time" in given:
        budget = float(given.pop(given.index("--time") + 1))
    numbers = [word for word in given if not word.startswith("--")]
    main(int(numbers[0]) if numbers else 20, budget, walk="--walk" in given)
