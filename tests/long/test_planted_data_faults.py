# SPDX-License-Identifier: MIT
"""Verdicts on sound, thin and wrong data: alarms, and whether the cause is named.

A simulated rig measures slips of both signs at three loads, each twice. It is read as the command
reads it, from a table and a column map, and judged as `calibrate-slip` does, but with draws of the
Laplace approximation in place of the sampler's, so that a set takes seconds. Thin sets lack a part
of the sound one. Wrong sets have one fault each.
"""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import pytest

from model.arrays import Array
from model.bayes.checks.causes import Cause
from model.bayes.drawing.convergence import Convergence
from model.bayes.drawing.weighted import weighted_draws
from model.bayes.estimate import Agreement
from model.bayes.fit import prepare_fit, scaled_load_cell
from model.bayes.verdict import State, judge
from model.errors import ModelError
from model.slip.magic_formula import MagicFormula
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import draw_imperfections
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import SimulatedSweep, simulate_sweep
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import ZebroLabError

HALF = np.array([0.006, 0.012, 0.022, 0.035, 0.05, 0.08, 0.14, 0.3])
BOTH = tuple(np.concatenate([-HALF[::-1], HALF]).tolist()) * 2
DRIVING = (0.004, 0.008, 0.015, 0.025, 0.035, 0.05, 0.08, 0.14, 0.3, 0.6) * 2
PLAN = SweepPlan(slips=BOTH, loads=(4.0, 8.0, 12.0), rate=100.0)
CONVERGED = Convergence(
    0, 1000, np.ones(1), np.ones(1), np.full(1, 5e3), np.full(1, 5e3), np.full(1, 0.01)
)
GOOD = (State.TRUSTWORTHY, State.AS_TESTED)
COLUMNS = """
source = "sim:verdicts"
columns.normal_force = { name = "normal_force", unit = "N" }
columns.traction_force = { name = "traction_force", unit = "N" }
constants = { radius_leg = "35 mm", radius_ground = "120 mm" }
runs.by = ["run"]
"""
SLIP_COLUMN = 'columns.slip_ratio = { name = "slip_ratio", definition = "material" }\n'

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]


@dataclass(frozen=True)
class Data:
    """A simulated rig's log, with the column map it is read by."""

    table: pd.DataFrame
    sweep: SimulatedSweep
    columns: str = COLUMNS

    def with_(self, **columns: Array) -> "Data":
        """Return the data with columns replaced or added."""
        return replace(self, table=self.table.assign(**columns))

    @property
    def traction(self) -> Array:
        """Measured traction, shape (n,) [N]."""
        return self.table.traction_force.to_numpy()

    def of_share(self, share: float) -> Array:
        """Choose a share of the runs; return whether each sample is in one, shape (n,)."""
        run = self.table.run.to_numpy()
        n_runs = int(run.max()) + 1
        chosen = np.random.default_rng(99).permutation(n_runs)[: max(1, round(share * n_runs))]
        return np.isin(run, chosen)


def sound(seed: int, **plan: object) -> Data:
    """Simulate a rig with nothing wrong but what the model has, load cell and all."""
    rng = np.random.default_rng(seed)
    sweep = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=replace(PLAN, **plan),
        imperfections=draw_imperfections(rng), rng=rng,
    )  # fmt: skip
    return Data(pd.DataFrame(sweep.table), sweep)


def judged(data: Data, folder) -> tuple[State | None, str]:
    """Read, fit and judge data; return the state, None where they are refused, and what is said."""
    table, columns = folder / "log.parquet", folder / "columns.toml"
    data.table.to_parquet(table)
    columns.write_text(data.columns, encoding="utf-8")
    rng = np.random.default_rng(1)
    try:
        found = read_rig_data([table], columns=columns)
        cell = scaled_load_cell(found.samples, {"zero_stability": 0.1, "gain_sd": 0.005})
        law = MagicFormula("peak")
        fit = prepare_fit(
            found.samples, law, load_cell=cell, rig_errors=found.rig_errors, rng=rng,
            validate=False,
        )  # fmt: skip
    except (ZebroLabError, ModelError) as error:
        return None, str(error)
    posterior = fit.posterior
    weighted = weighted_draws(posterior.log_density, fit.approximation, n=2000, rng=rng)
    z = weighted.resample(400, rng=rng)
    verdict = judge(
        fit, found.samples, z=z, convergence=CONVERGED, agreement=Agreement(0.0, 0.0, 0.0),
        contraction=dict(zip((p.name for p in posterior.free), 1 - z.var(axis=0), strict=True)),
    )  # fmt: skip
    notes = [note for note in found.notes if note.startswith("IMPROBABLE")]
    return verdict.state, " ".join([verdict.headline(), *notes])


def one_run(seed: int) -> Data:
    """Sweep slip through all set-points within one run at one load."""
    data = sound(seed, slips=tuple(sorted(BOTH)), loads=(8.0,))
    return data.with_(run=0 * data.table.run.to_numpy())


LOW_SLIPS = tuple(np.concatenate([-HALF[:3], HALF[:3]]).tolist()) * 2
THIN = {
    "one run": one_run,
    "one load": lambda seed: sound(seed, loads=(8.0,)),
    "one side": lambda seed: sound(seed, slips=DRIVING),
    "too short": lambda seed: sound(seed, slips=BOTH[:16], duration=0.1),
    "slip below the peak": lambda seed: sound(seed, slips=LOW_SLIPS, loads=(8.0, 12.0)),
    "no repeat": lambda seed: sound(seed, slips=BOTH[:16]),
}
"""Sets that can test too little."""


def drift(data: Data) -> Array:
    """Grow from 0 to 1 through the experiment, shape (n,)."""
    return np.linspace(0, 1, len(data.table))


def swapped_speeds(data: Data) -> Data:
    """Exchange the disc speeds."""
    leg, ground = data.table.omega_leg.to_numpy(), data.table.omega_ground.to_numpy()
    return data.with_(omega_leg=ground, omega_ground=leg)


def slip_definition(data: Data) -> Data:
    """Bend the slip twice as much as travel slip that is called material would be."""
    slip = data.sweep.samples.slip
    bent = slip + 2 * (slip / (1 - slip) - slip)
    table = data.table.drop(columns=["omega_leg", "omega_ground"]).assign(slip_ratio=bent)
    return replace(data, table=table, columns=COLUMNS + SLIP_COLUMN)


def outlying(data: Data) -> Data:
    """Add 3 N of either sign to a tenth of the samples."""
    rng, n = np.random.default_rng(5), len(data.table)
    return data.with_(
        traction_force=data.traction + 3 * (rng.random(n) < 0.1) * rng.choice([-1, 1], n)
    )


def late(data: Data) -> Data:
    """Delay traction by a twentieth of a second in runs that sweep slip up and down."""
    rng, t = np.random.default_rng(5), np.tile(np.arange(0.0, 12.0, 1 / PLAN.rate), 6)
    run = np.repeat(np.arange(6), len(t) // 6)
    slip, load = 0.2 * np.sin(t), np.where(run % 2, 4.0, 12.0)
    force = THESIS_LAW.force(0.2 * np.sin(t - 0.05), load, THESIS_VALUES)
    noise = 0.05 * rng.standard_normal(6)[run] + 0.03 * rng.standard_normal(len(t))
    table = pd.DataFrame({"t": t + 20 * run, "run": run, "slip_ratio": slip, "normal_force": load})
    return replace(
        data, table=table.assign(traction_force=force + noise), columns=COLUMNS + SLIP_COLUMN
    )


def run_out(data: Data) -> Data:
    """Run the leg disc 0.6 mm out of true: true slip swings with its angle."""
    slip, load = data.sweep.slip_true, data.sweep.load_true
    swing = (1 - slip) * 6e-4 / 0.035 * np.sin(12.0 * data.table.t.to_numpy())
    change = THESIS_LAW.force(slip + swing, load, THESIS_VALUES)
    change = change - THESIS_LAW.force(slip, load, THESIS_VALUES)
    return data.with_(traction_force=data.traction + change)


def clipped_cell(data: Data) -> Data:
    """Stop the reading of traction at 0.6 of its largest."""
    limit = 0.6 * float(np.quantile(np.abs(data.traction), 0.999))
    return data.with_(traction_force=np.clip(data.traction, -limit, limit))


def follows_column(data: Data) -> Data:
    """Raise friction with a column that the map does not name."""
    run = data.table.run.to_numpy()
    room = np.random.default_rng(4).normal(20.0, 2.0, int(run.max()) + 1)[run]
    return data.with_(traction_force=data.traction * (1 + 0.04 * (room - 20.0)), room=room)


def scaled(factor):
    """Return a fault that multiplies the traction by a function of the data."""
    return lambda data: data.with_(traction_force=data.traction * factor(data))


def added(force):
    """Return a fault that adds a function of the data to the traction [N]."""
    return lambda data: data.with_(traction_force=data.traction + force(data))


WRONG = {
    "sign": (scaled(lambda _: -1.0), "opposes"),
    "kN": (scaled(lambda _: 1e-3), "unit"),
    "swapped speeds": (swapped_speeds, "exchange"),
    "slip definition": (slip_definition, Cause.DEFINITION),
    "drifted zero": (added(lambda data: 1.2 * drift(data)), Cause.FORCE_ZERO),
    "outliers": (outlying, Cause.OUTLIERS),
    "two materials": (scaled(lambda data: np.where(data.of_share(0.5), 0.6, 1.0)), Cause.MATERIALS),
    "delay": (late, Cause.TIMING),
    "run-out": (run_out, Cause.RUN_OUT),
    "clipped cell": (clipped_cell, Cause.SATURATION),
    "wrong radius": (
        lambda data: replace(data, columns=COLUMNS.replace("35", "35.8")), Cause.SLIP_ZERO,
    ),
    "warming": (scaled(lambda data: 1 - 0.2 * drift(data)), Cause.OVER_TIME),
    "uneven gain": (
        scaled(lambda data: np.where(data.traction < 0, 0.76, 1.0)), Cause.ONE_DIRECTION,
    ),
    "another floor": (follows_column, Cause.COLUMN),
}  # fmt: skip
"""Faults of rigs and tables, and words that name each."""


@pytest.mark.parametrize("name", THIN)
def test_thin_data_are_trusted_as_far_as_they_were_tested(name, tmp_path):
    state, said = judged(THIN[name](1), tmp_path)
    assert state == State.AS_TESTED
    assert "untested: " in said


@pytest.mark.parametrize("name", WRONG)
def test_wrong_data_are_not_trusted_and_their_fault_is_named(name, tmp_path):
    make, words = WRONG[name]
    state, said = judged(make(sound(0)), tmp_path)
    assert state not in GOOD
    assert words in said, said


def test_a_rolling_resistance_of_four_times_its_scale_is_estimated_and_no_fault(tmp_path):
    state, said = judged(added(lambda data: -0.08 * data.table.normal_force)(sound(0)), tmp_path)
    assert state in GOOD, said


@pytest.mark.parametrize("slips", [BOTH, DRIVING], ids=["two-sided", "one-sided"])
def test_sound_data_raise_hardly_any_alarm(slips, tmp_path):
    states = [judged(sound(seed, slips=slips), tmp_path)[0] for seed in range(20)]
    assert sum(state not in GOOD for state in states) <= 2  # with 1 in 20, more in 8 of 100 trials
