# SPDX-License-Identifier: MIT
"""Trial of `calibrate-slip` on simulated rigs of other laboratories: coverage, alarms and causes.

    python -m benchmarks.accuracy.stranger_trial OUT.jsonl --designs abcdefgh --seeds 20
    python -m benchmarks.accuracy.stranger_trial OUT.jsonl --designs abcf --seeds 1 --faults all

fits the first answer (weighted draws, no emcee) to each data set of `stranger_rigs`, appends one
line of JSON a data set to OUT, and prints tables of all lines: how often 90 % intervals hold K and
mu, how often sound data are called not trustworthy, errors beside those of plain least squares, and
of faults that move the plain fit by `MOVED` what is said of them. Lines that OUT has are not made
again.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.stranger_faults import FAULTS
from benchmarks.accuracy.stranger_rigs import DESIGNS
from benchmarks.accuracy.stranger_rigs import main as simulate
from model.bayes.checks.causes import Cause
from model.bayes.drawing.convergence import Convergence
from model.bayes.drawing.weighted import weighted_draws
from model.bayes.estimate import Agreement
from model.bayes.fit import PreparedFit, prepare_fit, scaled_load_cell
from model.bayes.law_scores import choose_by_runs
from model.bayes.verdict import State, judge
from model.errors import ModelError
from zebro_lab.calibration.candidates import candidates
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import ZebroLabError

MOVED = 0.1  # relative change of the plain fit by a fault, from which it counts
NAMES = {"K": "slip_stiffness", "mu": "friction"}
CONVERGED = Convergence(
    0, 1000, np.ones(1), np.ones(1), np.full(1, 5e3), np.full(1, 5e3), np.full(1, 0.01)
)
RIGHT = {
    "force zero": Cause.FORCE_ZERO, "slip zero": Cause.SLIP_ZERO, "force scale": Cause.FORCE_SCALE,
    "one direction": Cause.ONE_DIRECTION, "load column": Cause.LOAD, "crosstalk": Cause.CROSSTALK,
    "timing": Cause.TIMING, "slip definition": Cause.DEFINITION, "saturation": Cause.SATURATION,
    "frozen samples": Cause.FROZEN, "outliers": Cause.OUTLIERS, "stick-slip": Cause.STICK_SLIP,
    "friction over time": Cause.OVER_TIME, "two materials": Cause.MATERIALS,
    "hidden variable": Cause.COLUMN, "hysteresis": Cause.HYSTERESIS,
}  # fmt: skip
"""The trial's names of causes, as the verdict names them."""


def first_answer(data: RigData, folder: Path) -> tuple[PreparedFit, np.random.Generator]:
    """Prepare the fit that `calibrate-slip` would sample."""
    rng, samples, choice = np.random.default_rng(1), data.samples, None
    laws = candidates(CalibrationRequest((folder,), folder / "out"), samples)
    cell, fits = scaled_load_cell(samples, data.load_cell), {}
    for name, law in laws.items():
        fits[name] = prepare_fit(
            samples, law, load_cell=cell, rig_errors=data.rig_errors, rng=rng,
            block_choice=choice, validate=len(laws) > 1,
        )  # fmt: skip
        choice = fits[name].block_choice
    return choose_by_runs(fits)[0], rng


def answer(folder: Path) -> dict[str, Any]:
    """Read, fit and judge a data set; return quantiles of K and mu, and what is said."""
    try:
        data = read_rig_data([folder])
        fit, rng = first_answer(data, folder)
    except (ZebroLabError, ModelError) as error:
        return {"state": "refused", "says": str(error)}
    posterior = fit.posterior
    weighted = weighted_draws(posterior.log_density, fit.approximation, n=1000, wanted=400, rng=rng)
    z = weighted.resample(2000, rng=rng)
    spread = posterior.own_coordinates(z).var(axis=0)
    verdict = judge(
        fit, data.samples, z=z[:400],
        contraction={p.name: 1 - v for p, v in zip(posterior.free, spread, strict=True)},
        convergence=CONVERGED, agreement=Agreement(0.0, 0.0, 0.0),
    )  # fmt: skip
    values = dict(zip((p.name for p in posterior.parameters), posterior.values(z).T, strict=True))
    plain = dict(zip((p.name for p in posterior.law.parameters), fit.plain.values, strict=True))
    return {
        "state": str(verdict.state), "says": verdict.headline(), "causes": list(verdict.causes),
        "pareto_k": weighted.pareto_k,
        **{k: np.quantile(values[name], [0.05, 0.5, 0.95]).tolist() for k, name in NAMES.items()},
        "plain": {k: float(plain[name]) for k, name in NAMES.items()},
    }  # fmt: skip


def records(out: Path, designs: str, seeds: range, faults: list[str], sizes: list[int]) -> None:
    """Append the records that a file lacks."""
    known = {(r["design"], r["seed"], r["fault"], r["size"]) for r in read(out)}
    wanted = [(d, s, f, n) for s in seeds for d in designs for f in faults for n in sizes]
    for design, seed, fault, size in wanted:
        if (design, seed, fault, size) in known:
            continue
        with tempfile.TemporaryDirectory() as place:
            folder, given = Path(place) / "rig", ["--design", design, "--seed", str(seed)]
            if fault:
                if FAULTS[fault].needs not in DESIGNS[design].has | {""}:
                    continue
                given += ["--fault", fault, "--size", str(size)]
            simulate([str(folder), *given])
            truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
            (folder / "truth.json").unlink()
            began = time.perf_counter()
            found = answer(folder)
        about = {"design": design, "seed": seed, "fault": fault, "size": size}
        true = {"true": {k: truth[k] for k in NAMES}, "right": truth.get("right_causes", [])}
        line = json.dumps({**about, **true, **found, "seconds": time.perf_counter() - began})
        with out.open("a", encoding="utf-8") as file:
            file.write(line + "\n")


def read(out: Path) -> list[dict[str, Any]]:
    """Read the records of a file; none where there is no file."""
    if not out.exists():
        return []
    return [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]


def sound_table(found: list[dict[str, Any]]) -> Iterator[str]:
    """Yield lines of a table of the sound data sets, a row a design."""
    yield "| design | sets | not trustworthy | 90 % hold K, mu | error of K, mu over plain |"
    yield "|---|---:|---:|---:|---:|"
    sound = [r for r in found if not r["fault"] and "plain" in r]
    for name in [*sorted({r["design"] for r in sound}), "all"]:
        rows = [r for r in sound if name in (r["design"], "all")]
        bad = sum(r["state"] == State.NOT_TRUSTWORTHY for r in rows)
        holds = [np.mean([r[k][0] <= r["true"][k] <= r[k][2] for r in rows]) for k in NAMES]
        ratio = [
            sum(abs(r[k][1] - r["true"][k]) / r["true"][k] for r in rows)
            / sum(abs(r["plain"][k] - r["true"][k]) / r["true"][k] for r in rows)
            for k in NAMES
        ]
        yield (
            f"| {name} | {len(rows)} | {bad} | {holds[0]:.0%}, {holds[1]:.0%} | "
            f"{ratio[0]:.2f}, {ratio[1]:.2f} |"
        )


def fault_table(found: list[dict[str, Any]]) -> Iterator[str]:
    """Yield lines of a table of the faults that move the plain fit, a row a fault."""
    yield "| fault | sets that count | plainly trustworthy | cause named | a wrong one alone |"
    yield "|---|---:|---:|---:|---:|"
    sound = {(r["design"], r["seed"]): r for r in found if not r["fault"] and "plain" in r}
    total = np.zeros(4, dtype=int)
    for fault in sorted({r["fault"] for r in found if r["fault"]}):
        rows = [r for r in found if r["fault"] == fault and _moved(r, sound)]
        right = [
            {str(RIGHT[each]) for each in r["right"] if each in RIGHT} & set(r.get("causes", []))
            for r in rows
        ]
        refused = [r["state"] == "refused" for r in rows]
        plainly = sum(r["state"] == State.TRUSTWORTHY for r in rows)
        named = sum(bool(a) or b for a, b in zip(right, refused, strict=True))
        alone = sum(
            len(r.get("causes", [])) == 1 and not a for r, a in zip(rows, right, strict=True)
        )
        counts = np.array([len(rows), plainly, named, alone])
        total += counts
        yield f"| {fault} | {' | '.join(map(str, counts))} |"
    yield f"| all | {' | '.join(map(str, total))} |"


def _moved(record: dict[str, Any], sound: dict[tuple[str, int], dict[str, Any]]) -> bool:
    """Return whether a fault moves the plain fit by `MOVED`, or its data are refused."""
    beside = sound.get((record["design"], record["seed"]))
    if record["state"] == "refused":
        return True
    return beside is not None and any(
        abs(record["plain"][k] / beside["plain"][k] - 1) >= MOVED for k in NAMES
    )


def main() -> None:
    """Make what is missing and print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("out", type=Path, help="file of JSON lines")
    parser.add_argument("--designs", default="".join(DESIGNS))
    parser.add_argument("--seeds", type=int, default=20, help="seeds from 1 to this one")
    parser.add_argument("--faults", default="", help="names with commas, or all")
    parser.add_argument("--sizes", default="1,2,3,4,5")
    given = parser.parse_args()
    seeds = range(1, given.seeds + 1)
    records(given.out, given.designs, seeds, [""], [0])
    if given.faults:
        faults = list(FAULTS) if given.faults == "all" else given.faults.split(",")
        sizes = [int(each) for each in given.sizes.split(",")]
        records(given.out, given.designs, seeds, faults, sizes)
    found = read(given.out)
    for line in (*sound_table(found), "", *fault_table(found)):
        print(line)


if __name__ == "__main__":
    main()
