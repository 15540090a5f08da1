# SPDX-License-Identifier: MIT
"""The thesis's whole plan on the twin, seed after seed: is the truth found, and by which slip?

The same data are fitted twice: with the slip ratio that was measured at every instant, and with the
commanded one, which is all that the thesis had.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import chi2

from model.bayes.drawing.weighted import importance_draws
from model.bayes.fit import prepare_fit
from model.bayes.posterior import LoadCell
from model.slip.definition import SlipDefinition
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.experiment.control import Control
from rig.experiment.run import run_plan
from rig.slip_rig.decode import measured_slip
from support.memory_sink import MemorySink
from zebro_lab.experiment.opened_rig import opened_rig
from zebro_lab.experiment.plan_stage import read_plan

pytestmark = pytest.mark.long

N_SEEDS = 10
PLAN = Path(__file__).parents[2] / "examples" / "plan-thesis.toml"
LOAD_CELL = LoadCell(zero_stability=0.1, gain_sd=0.005, bias_sd=0.05, crosstalk_sd=0.005)
TRUTH = np.array(THESIS_VALUES)
SYMBOLS = [parameter.symbol for parameter in THESIS_LAW.parameters]
DRAWS = 10_000


@dataclass(frozen=True)
class Fitted:
    """One posterior beside the truth, in logarithms: miss, covariance and chi-square."""

    miss: np.ndarray
    sd: np.ndarray
    chi_square: float


def say(line: str) -> None:
    print(line, flush=True)  # noqa: T201 the table is what `make test-long` is run for


def measure(seed: int) -> tuple[SlipSamples, SlipSamples]:
    """Run the plan; return its samples with measured and with commanded slip."""
    with opened_rig("sim", seed=seed, fast=True) as rig:
        plan, control, sink = read_plan(PLAN), Control(), MemorySink()
        outcome = run_plan(
            plan, bench=rig.bench, load=rig.load_setter(plan.load, control), sink=sink,
            control=control, clock=rig.clock, period=rig.period,
        )  # fmt: skip
        assert outcome.completed
        assert not outcome.refused
        runs, profile = sink.accepted, rig.bench.profile
    readings = [run.readings for run in runs]
    sizes = [len(part) for part in readings]
    measured = SlipSamples(
        slip=np.concatenate(
            [measured_slip(part.omega_leg, part.omega_ground, profile) for part in readings]
        ),
        normal_force=np.concatenate([part.normal_force for part in readings]),
        traction_force=np.concatenate([part.traction_force for part in readings]),
        run=np.repeat(np.arange(len(runs)), sizes),
        run_names=tuple(run.start.point.label for run in runs),
        definition=SlipDefinition.MATERIAL,
        time=np.concatenate([part.t for part in readings]),
    )
    commanded = np.repeat([run.start.point.slips[0] for run in runs], sizes)
    return measured, replace(measured, slip=commanded)


def fit(samples: SlipSamples, seed: int) -> Fitted:
    rng = np.random.default_rng(seed)
    found = prepare_fit(samples, THESIS_LAW, load_cell=LOAD_CELL, rng=rng, validate=False)
    weighted = importance_draws(found.posterior.log_density, found.approximation, n=DRAWS, rng=rng)
    draws = found.posterior.values(weighted.resample(DRAWS, rng=rng))[:, : len(TRUTH)]
    miss = np.log(draws).mean(axis=0) - np.log(TRUTH)
    covariance = np.cov(np.log(draws), rowvar=False)
    chi_square = float(miss @ np.linalg.solve(covariance, miss))
    return Fitted(miss, np.sqrt(np.diag(covariance)), chi_square)


def test_the_truth_is_found_by_measured_slip_and_missed_by_commanded():
    say(f"\n| seed | slip | χ² of 4 | {' | '.join(f'{s}: miss / sd' for s in SYMBOLS)} |")
    fits = {"measured": [], "commanded": []}
    for seed in range(N_SEEDS):
        for name, samples in zip(fits, measure(seed), strict=True):
            found = fit(samples, seed)
            fits[name].append(found)
            cells = " | ".join(
                f"{m:+.4f} / {s:.4f}" for m, s in zip(found.miss, found.sd, strict=True)
            )
            say(f"| {seed} | {name} | {found.chi_square:.2f} | {cells} |")
    p = {}
    for name, found in fits.items():
        total, freedom = sum(f.chi_square for f in found), len(TRUTH) * N_SEEDS
        p[name] = float(chi2.sf(total, freedom))
        bias = np.mean([f.miss for f in found], axis=0)
        width = np.median([f.sd for f in found], axis=0)
        say(f"{name}: joint χ² {total:.1f} of {freedom}, p = {p[name]:.3g}; bias "
            + ", ".join(f"{s} {b:+.2%}" for s, b in zip(SYMBOLS, bias, strict=True))
            + "; median sd "
            + ", ".join(f"{s} {w:.2%}" for s, w in zip(SYMBOLS, width, strict=True)))  # fmt: skip
    assert p["measured"] > 0.01
    bias = {name: np.abs(np.mean([f.miss for f in found], axis=0)) for name, found in fits.items()}
    assert bias["measured"][0] < bias["commanded"][0]
