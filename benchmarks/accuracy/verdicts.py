# SPDX-License-Identifier: MIT
"""Verdicts on sound, thin and wrong data: headlines, alarms, and whether the cause is named.

python -m benchmarks.accuracy.verdicts [SEEDS] [--only WAY] [--sound SETS]

A simulated rig measures slips of both signs at three loads, each twice. It is read as the command
reads it, from a table and a column map, and judged as `calibrate-slip` does, but with draws of the
Laplace approximation in place of the sampler's, so that a set takes seconds. Thin sets lack a part
of the sound one. Wrong sets have one fault, at three sizes; "moved" is how far the fault moves the
worst of stiffness, shape and friction, in posterior standard deviations of the sound fit. Last, the
advice on each fault is followed, and what comes of it is judged.
"""

import argparse
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from benchmarks.tables import print_table
from model.arrays import Array
from model.bayes.advice import CorrectData, ExcludeRuns
from model.bayes.checks.inspection import inspect
from model.bayes.checks.linear import linearise
from model.bayes.convergence import Convergence
from model.bayes.estimate import Agreement
from model.bayes.fit import prepare_fit, scaled_load_cell
from model.bayes.residuals import analyse_residuals
from model.bayes.verdict import State, Verdict, judge
from model.bayes.weighted import weighted_draws
from model.errors import ModelError
from model.slip.magic_formula import MagicFormula
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import draw_imperfections
from rig.slip_rig.sweep import SimulatedSweep, SweepPlan, simulate_sweep
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import ZebroLabError

HALF = np.array([0.006, 0.012, 0.022, 0.035, 0.05, 0.08, 0.14, 0.3])
BOTH = tuple(np.concatenate([-HALF[::-1], HALF]).tolist()) * 2
DRIVING = (0.004, 0.008, 0.015, 0.025, 0.035, 0.05, 0.08, 0.14, 0.3, 0.6) * 2
LOADS = (4.0, 8.0, 12.0)
RATE = 100.0
DRAWS = 400
CONVERGED = Convergence(
    0, 1000, np.ones(1), np.ones(1), np.full(1, 5e3), np.full(1, 5e3), np.full(1, 0.01)
)
FACTOR = re.compile(r"multiply radius_ground by ([0-9.]+)")
COLUMNS = """
source = "sim:verdicts"
[columns.normal_force]
name = "normal_force"
unit = "N"
[columns.traction_force]
name = "traction_force"
unit = "N"
[constants]
radius_leg = "35 mm"
radius_ground = "120 mm"
[runs]
by = ["run"]
"""


@dataclass(frozen=True)
class Data:
    """A simulated rig's log on the way to the fit.

    Attributes:
        table: Columns of the log.
        sweep: The simulation with the true values.
        columns: Text of the column map.
    """

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

    @property
    def run(self) -> Array:
        """Index of each sample's run, shape (n,)."""
        return self.table.run.to_numpy()


@dataclass(frozen=True)
class Judged:
    """What was said of a set.

    Attributes:
        said: The headline, or the line with which the data were refused.
        state: State of the verdict; None where the data were refused.
        verdict: The verdict; None where the data were refused.
        found: Mean and standard deviation of stiffness, friction and shape, (2, 3); None as well.
    """

    said: str
    state: State | None
    verdict: Verdict | None = None
    found: Array | None = None

    @property
    def text(self) -> str:
        """Headline and next steps, which name causes."""
        steps = self.verdict.next_steps() if self.verdict else ()
        return " ".join([self.said, *(f"{step.reason}" for step in steps)])


def sound(seed: int, slips: tuple[float, ...] = BOTH, **plan: object) -> Data:
    """Simulate a rig with nothing wrong but what the model has, load cell and all."""
    rng = np.random.default_rng(seed)
    settings = {"loads": LOADS, "rate": RATE, **plan}
    sweep = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=SweepPlan(slips=slips, **settings),
        imperfections=draw_imperfections(rng), rng=rng,
    )  # fmt: skip
    return Data(pd.DataFrame(sweep.table), sweep)


def read(data: Data) -> RigData:
    """Read data as the command does, from a table and a column map; faults raise `DataError`."""
    with tempfile.TemporaryDirectory() as folder:
        table, columns = Path(folder) / "log.parquet", Path(folder) / "columns.toml"
        data.table.to_parquet(table)
        columns.write_text(data.columns, encoding="utf-8")
        return read_rig_data([table], columns=columns)


def judged(data: Data, *, seed: int = 1) -> Judged:
    """Read, fit and judge data, with draws of the Laplace approximation."""
    rng = np.random.default_rng(seed)
    try:
        found = read(data)
        cell = scaled_load_cell(found.samples, {"zero_stability": 0.1, "gain_sd": 0.005})
        law = MagicFormula("peak")
        fit = prepare_fit(
            found.samples, law, load_cell=cell, rig_errors=found.rig_errors, rng=rng,
            validate=False,
        )  # fmt: skip
    except (ZebroLabError, ModelError) as error:
        return Judged(f"refused: {error}", None)
    posterior = fit.posterior
    weighted = weighted_draws(posterior.log_density, fit.approximation, n=2000, rng=rng)
    z = weighted.resample(DRAWS, rng=rng)
    values = posterior.values(z)
    verdict = judge(
        blocks=posterior.blocks, law=law, values=values,
        contraction=dict(zip((p.name for p in posterior.free), 1 - z.var(axis=0), strict=True)),
        convergence=CONVERGED, residuals=analyse_residuals(posterior.blocks, law, values),
        agreement=Agreement(0.0, 0.0, 0.0),
        inspection=inspect(
            posterior, linearise(posterior, z), found.samples, fit.block_choice
        ),
        offset_scale=cell.zero_stability,
    )  # fmt: skip
    used = values[:, :3]
    notes = "".join(f" [{note}]" for note in found.notes if note.startswith("IMPROBABLE"))
    return Judged(
        verdict.headline() + notes, verdict.state, verdict,
        np.stack([used.mean(axis=0), used.std(axis=0)]),
    )  # fmt: skip


def one_run(seed: int) -> Data:
    """Sweep slip through all set-points within one run at one load."""
    data = sound(seed, slips=tuple(sorted(BOTH)), loads=(8.0,))
    return data.with_(run=0 * data.run)


THIN: Mapping[str, Callable[[int], Data]] = {
    "one run": one_run,
    "one load": lambda seed: sound(seed, loads=(8.0,)),
    "one side": lambda seed: sound(seed, DRIVING),
    "too short": lambda seed: sound(seed, tuple(BOTH[:16]), duration=0.1),
    "slip below the peak": lambda seed: sound(
        seed, tuple(np.concatenate([-HALF[:3], HALF[:3]]).tolist()) * 2, loads=(8.0, 12.0)
    ),
    "no repeat": lambda seed: sound(seed, BOTH[:16]),
}
"""Sets that can test too little."""


def _changed_runs(data: Data, share: float, seed: int) -> NDArray[np.bool_]:
    """Choose a share of the runs at random; return whether each sample is in one, shape (n,)."""
    rng = np.random.default_rng(seed + 99)
    n_runs = int(data.run.max()) + 1
    return np.isin(data.run, rng.permutation(n_runs)[: max(1, round(share * n_runs))])


def wrong_sign(data: Data, size: float, seed: int) -> Data:
    """Turn the sign of traction in a share of the runs."""
    turned = _changed_runs(data, size, seed)
    return data.with_(traction_force=np.where(turned, -data.traction, data.traction))


def kilonewtons(data: Data, size: float, seed: int) -> Data:
    """Give traction (1), load (2) or both (3) in kN as if they were in N."""
    del seed
    change = {}
    if size != 2:
        change["traction_force"] = data.traction / 1000
    if size != 1:
        change["normal_force"] = data.table.normal_force.to_numpy() / 1000
    return data.with_(**change)


def swapped_speeds(data: Data, size: float, seed: int) -> Data:
    """Exchange the disc speeds in a share of the runs."""
    swapped = _changed_runs(data, size, seed)
    leg, ground = data.table.omega_leg.to_numpy(), data.table.omega_ground.to_numpy()
    return data.with_(
        omega_leg=np.where(swapped, ground, leg), omega_ground=np.where(swapped, leg, ground)
    )


def slip_definition(data: Data, size: float, seed: int) -> Data:
    """Bend the slip `size` times as travel slip that is called material would be."""
    del seed
    slip = data.sweep.samples.slip
    bent = slip + size * (slip / (1 - slip) - slip)
    columns = COLUMNS + '[columns.slip_ratio]\nname = "slip_ratio"\ndefinition = "material"\n'
    table = data.table.drop(columns=["omega_leg", "omega_ground"]).assign(slip_ratio=bent)
    return replace(data, table=table, columns=columns)


def drifted_zero(data: Data, size: float, seed: int) -> Data:
    """Let the zero of traction drift by `size` newtons through the experiment."""
    del seed
    return data.with_(traction_force=data.traction + size * np.linspace(0, 1, len(data.run)))


def outlying(data: Data, size: float, seed: int) -> Data:
    """Add 3 N of either sign to a share of the samples."""
    rng = np.random.default_rng(seed + 5)
    hit = rng.random(len(data.run)) < size
    return data.with_(traction_force=data.traction + 3 * hit * rng.choice([-1, 1], len(data.run)))


def two_materials(data: Data, size: float, seed: int) -> Data:
    """Measure half of the runs on a material with a friction lower by the share `size`."""
    other = _changed_runs(data, 0.5, seed)
    return data.with_(traction_force=data.traction * np.where(other, 1 - size, 1.0))


def late(data: Data, size: float, seed: int) -> Data:
    """Delay traction by `size` seconds within each run."""
    del seed
    steps, force = round(size * RATE), data.traction.copy()
    for part in data.sweep.samples.slices():
        force[part] = np.append(np.full(steps, force[part][0]), force[part])[: len(force[part])]
    return data.with_(traction_force=force)


def run_out(data: Data, size: float, seed: int) -> Data:
    """Run the leg disc `size` metres out of true: true slip swings with its angle."""
    del seed
    plan_radius, omega = 0.035, 12.0
    slip, load = data.sweep.slip_true, data.sweep.load_true
    swing = (1 - slip) * size / plan_radius * np.sin(omega * data.table.t.to_numpy())
    change = THESIS_LAW.force(slip + swing, load, THESIS_VALUES)
    change = change - THESIS_LAW.force(slip, load, THESIS_VALUES)
    return data.with_(traction_force=data.traction + change)


def clipped_cell(data: Data, size: float, seed: int) -> Data:
    """Stop the reading of traction at a share `1 - size` of its largest."""
    del seed
    limit = (1 - size) * float(np.quantile(np.abs(data.traction), 0.999))
    return data.with_(traction_force=np.clip(data.traction, -limit, limit))


def wrong_radius(data: Data, size: float, seed: int) -> Data:
    """State the leg disc's radius `size` metres too large."""
    del seed
    return replace(data, columns=COLUMNS.replace("35 mm", f"{35 + 1e3 * size:.3f} mm"))


def rolling_resistance(data: Data, size: float, seed: int) -> Data:
    """Subtract `size` times the load from the traction."""
    del seed
    return data.with_(traction_force=data.traction - size * data.table.normal_force.to_numpy())


def warming(data: Data, size: float, seed: int) -> Data:
    """Let friction fall by the share `size` through the experiment."""
    del seed
    return data.with_(traction_force=data.traction * (1 - size * np.linspace(0, 1, len(data.run))))


def uneven_gain(data: Data, size: float, seed: int) -> Data:
    """Read braking forces smaller by the share `size`."""
    del seed
    return data.with_(traction_force=data.traction * np.where(data.traction < 0, 1 - size, 1.0))


@dataclass(frozen=True)
class Way:
    """A way in which data can be wrong.

    Attributes:
        make: Function of sound data, size and seed to wrong data.
        sizes: Three sizes.
        names: Words of which one has to be said.
    """

    make: Callable[[Data, float, int], Data]
    sizes: tuple[float, float, float]
    names: tuple[str, ...]


WRONG: Mapping[str, Way] = {
    "sign": Way(wrong_sign, (0.1, 0.5, 1.0), ("opposes",)),
    "kN": Way(kilonewtons, (1.0, 2.0, 3.0), ("unit",)),
    "swapped speeds": Way(swapped_speeds, (0.1, 0.5, 1.0), ("exchange", "swapped")),
    "slip definition": Way(slip_definition, (0.5, 1.0, 2.0), ("definition",)),
    "drifted zero": Way(drifted_zero, (0.3, 0.6, 1.2), ("drift", "zero of")),
    "outliers": Way(outlying, (0.005, 0.02, 0.1), ("outliers",)),
    "two materials": Way(two_materials, (0.1, 0.2, 0.4), ("material",)),
    "delay": Way(late, (0.02, 0.05, 0.1), ("late", "delay")),
    "run-out": Way(run_out, (5e-5, 1e-4, 2e-4), ("run-out", "turns")),
    "clipped cell": Way(clipped_cell, (0.05, 0.2, 0.4), ("clipped",)),
    "wrong radius": Way(wrong_radius, (2e-4, 4e-4, 8e-4), ("radi",)),
    "rolling resistance": Way(rolling_resistance, (0.02, 0.04, 0.08), ("rolling",)),
    "warming": Way(warming, (0.05, 0.1, 0.2), ("warming", "change")),
    "uneven gain": Way(uneven_gain, (0.06, 0.12, 0.24), ("driving",)),
}
"""Faults of rigs and tables."""


def _rows(data: Data, kept: NDArray[np.bool_]) -> Data:
    """Leave rows out, as [rows] keep does."""
    return replace(data, table=data.table[kept].reset_index(drop=True))


def _sorted_out(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Exclude the runs that the advice names."""
    del size, seed
    names = {name for step in found.next_steps() if isinstance(step, ExcludeRuns)
             for name in step.runs}  # fmt: skip
    bad = [int(name.split("=")[1]) for name in names]
    return _rows(data, ~np.isin(data.run, bad))


def _radius_corrected(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Multiply the ground disc's radius by the factor that the advice states."""
    del size, seed
    steps = [step.step for step in found.next_steps() if isinstance(step, CorrectData)]
    (factor,) = {match[1] for step in steps if (match := FACTOR.search(step))}
    radius = f"{120 * float(factor):.4f} mm"
    return replace(data, columns=data.columns.replace("120 mm", radius))


def _zero_slip_subtracted(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Measure traction at zero slip under each load, here exactly, and subtract it."""
    del found, seed
    return data.with_(traction_force=data.traction + size * data.table.normal_force.to_numpy())


def _spikes_skipped(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Skip the rows with spikes that the log shows."""
    del found, size
    clean = sound(seed).traction
    return _rows(data, np.abs(data.traction - clean) < 1.0)


def _material_alone(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Fit the runs of one material alone."""
    del found, size
    return _rows(data, ~_changed_runs(data, 0.5, seed))


def _definition_converted(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Convert slip that was divided by the speed of travel, as the advice says."""
    del found, size, seed
    slip = data.table.slip_ratio.to_numpy()
    return data.with_(slip_ratio=slip / (1 + slip))


def _driving_alone(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Fit driving apart from braking."""
    del found, size, seed
    return _rows(data, data.run % len(BOTH[:16]) >= len(HALF))


def _runs_below_the_limit(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Leave out the runs that reach the cell's limit."""
    del found, size, seed
    limit = float(np.abs(data.traction).max())
    reached = np.unique(data.run[np.abs(data.traction) >= limit])
    return _rows(data, ~np.isin(data.run, reached))


def _measured_again(data: Data, found: Verdict, size: float, seed: int) -> Data:
    """Measure again with what the advice mends, and fit the new runs alone."""
    del data, found, size
    return sound(seed + 1000)


CURES: Mapping[str, tuple[float, Callable[[Data, Verdict, float, int], Data]]] = {
    "sign": (0.1, _sorted_out),
    "slip definition": (1.0, _definition_converted),
    "drifted zero": (0.6, _measured_again),
    "outliers": (0.005, _spikes_skipped),
    "two materials": (0.2, _material_alone),
    "delay": (0.05, _measured_again),
    "run-out": (2e-4, _measured_again),
    "clipped cell": (0.05, _runs_below_the_limit),
    "wrong radius": (4e-4, _radius_corrected),
    "rolling resistance": (0.08, _zero_slip_subtracted),
    "warming": (0.1, _measured_again),
    "uneven gain": (0.24, _driving_alone),
}
"""A size of each fault, and what its advice makes of the data."""


def cured(name: str, seed: int) -> tuple[Judged, Judged]:
    """Judge data with a fault, and what becomes of them where the advice is followed."""
    size, cure = CURES[name]
    data = WRONG[name].make(sound(seed), size, seed)
    before = judged(data)
    if before.verdict is None:
        return before, before
    return before, judged(cure(data, before.verdict, size, seed))


def cured_rows(names: list[str], seeds: int) -> Iterator[tuple[str, ...]]:
    """Follow the advice on each fault; make a row of each, over the seeds."""
    good = (State.TRUSTWORTHY, State.AS_TESTED)
    for name in names:
        found = [cured(name, seed) for seed in range(seeds)]
        yield (
            name, f"{CURES[name][0]:g}",
            f"{sum(before.state not in good for before, _ in found)} of {seeds}",
            f"{sum(after.state in good for _, after in found)} of {seeds}",
            found[0][1].said,
        )  # fmt: skip


def main(arguments: list[str] | None = None) -> None:
    """Print the tables of sound, thin and wrong sets."""
    parser = argparse.ArgumentParser(description="Judge sound, thin and wrong data.")
    parser.add_argument("seeds", type=int, nargs="?", default=5)
    parser.add_argument("--only", default="", help="part of the name of the ways to make")
    parser.add_argument("--sound", type=int, default=0, help="number of sound sets")
    asked = parser.parse_args(arguments)
    if asked.sound:
        print_table(("sound sets", "alarms", "trustworthy", "as far as tested", "failed checks"),
                    *sound_rows(asked.sound))  # fmt: skip
    thin = [name for name in THIN if asked.only in name]
    if thin:
        print_table(("thin set", "seed", "headline"), *thin_rows(thin, asked.seeds))
    wrong = [name for name in WRONG if asked.only in name]
    if wrong:
        print_table(("fault", "size", "moved [sd]", "trusted", "named", "headline of the first"),
                    *wrong_rows(wrong, asked.seeds))  # fmt: skip
    cures = [name for name in CURES if asked.only in name]
    if cures:
        print_table(("fault", "size", "not trusted", "trusted after the advice", "headline then"),
                    *cured_rows(cures, asked.seeds))  # fmt: skip


def sound_rows(n: int) -> Iterator[tuple[str, ...]]:
    """Judge n sound sets, half of them two-sided and half driving only; make a row of each kind."""
    for kind, slips, sets in (("two-sided", BOTH, n - n // 2), ("one-sided", DRIVING, n // 2)):
        found = [judged(sound(seed, slips)) for seed in range(sets)]
        states = [each.state for each in found]
        failed = [c.name for each in found if each.verdict
                  for c in each.verdict.checks if c.failed]  # fmt: skip
        good = (State.TRUSTWORTHY, State.AS_TESTED)
        yield (
            f"{sets} {kind}", str(sum(state not in good for state in states)),
            str(states.count(State.TRUSTWORTHY)), str(states.count(State.AS_TESTED)),
            ", ".join(failed),
        )  # fmt: skip


def thin_rows(names: list[str], seeds: int) -> Iterator[tuple[str, ...]]:
    """Judge thin sets; make a row of each."""
    for name in names:
        for seed in range(seeds):
            yield name, str(seed), judged(THIN[name](seed)).said


def moved(found: Judged, base: Judged) -> float:
    """Compute how far values moved, in posterior standard deviations of the sound fit [-].

    Infinite where the data were refused.
    """
    if found.found is None or base.found is None:
        return float("inf")
    return float(np.max(np.abs(found.found[0] - base.found[0]) / base.found[1]))


def is_named(found: Judged, way: Way) -> bool:
    """Return whether headline, refusal or advice name the fault."""
    return any(word in found.text for word in way.names)


def wrong_rows(names: list[str], seeds: int) -> Iterator[tuple[str, ...]]:
    """Judge wrong sets; make a row of each fault and size, over the seeds."""
    base = [judged(sound(seed)) for seed in range(seeds)]
    for name in names:
        way = WRONG[name]
        for size in way.sizes:
            found = [judged(way.make(sound(seed), size, seed)) for seed in range(seeds)]
            trusted = [each.state in (State.TRUSTWORTHY, State.AS_TESTED) for each in found]
            far = [moved(each, one) for each, one in zip(found, base, strict=True)]
            yield (
                name, f"{size:g}", f"{np.median(far):.1f}", f"{sum(trusted)} of {seeds}",
                f"{sum(is_named(each, way) for each in found)} of {seeds}", found[0].said,
            )  # fmt: skip


if __name__ == "__main__":
    main()
