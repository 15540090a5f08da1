# SPDX-License-Identifier: MIT
"""By commands: last year's half as the prior of this year's half is all data."""

import shutil
import tomllib
from pathlib import Path

import pandas as pd
import pytest

from model.bayes.checks.faults import NOISE
from model.bayes.likelihood import NUISANCE
from model.slip.thesis import THESIS_LAW
from support.calibrate_processes import patched, run

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]

RIG = Path(__file__).parents[2] / "datasets" / "rig-sim"
FIXED = """
from dataclasses import replace
from model.slip.magic_formula import MagicFormula
from zebro_lab.calibration import stage
sampler = stage._sampler
stage._sampler = lambda *given: replace(sampler(*given), block_length=48)
stage.candidates = lambda *_: {"magic-formula": MagicFormula()}
"""
"""Both years have blocks of one length and one law, so that they can be compared with all data."""
SEEDS = (1, 2)
"""Of a fit's 4,000 draws a spread is known to 1.3 %, and three fits enter a comparison."""
NAMES = [p.name for p in (*THESIS_LAW.parameters, *NUISANCE)]


@pytest.fixture(scope="module")
def folders(tmp_path_factory) -> dict[str, Path]:
    """Fit both halves of the runs, all of them, and this year's with last year's as prior."""
    base = tmp_path_factory.mktemp("halves")
    for half, year in enumerate(("last", "this")):
        (base / year).mkdir()
        for table in RIG.glob("*.csv.gz"):
            rows = pd.read_csv(table)
            rows[rows["run"] % 2 == half].to_csv(base / year / table.name, index=False)
        shutil.copy(RIG / "columns.toml", base / year)
    fits = {"alone": (base / "this",)}
    for seed in SEEDS:
        earlier = base / f"fit-last-{seed}"
        fits |= {
            f"last-{seed}": (base / "last", "--seed", seed),
            f"all-{seed}": (RIG, "--seed", seed),
            f"both-{seed}": (base / "this", "--prior-from", earlier, "--seed", seed),
        }
    for name, arguments in fits.items():
        ended = run(patched(FIXED, *arguments, "--out", base / f"fit-{name}"))
        assert ended.returncode == 0, ended.stderr
    return {name: base / f"fit-{name}" for name in fits} | {"data": base / "this"}


def summary(*folders: Path) -> pd.DataFrame:
    """Return means and spreads of parameters, averaged over fits that differ by the seed."""
    tables = [pd.read_csv(each / "summary.csv", index_col="parameter") for each in folders]
    return sum(each[["mean", "sd"]] for each in tables) / len(tables)


def test_the_halves_together_are_all_data(folders):
    both, whole = (
        summary(*(folders[f"{name}-{seed}"] for seed in SEEDS)) for name in ("both", "all")
    )
    off = (both["mean"] - whole["mean"]) / whole["sd"]
    wider = both["sd"] / whole["sd"] - 1
    assert (off.abs() < 0.2).all(), off
    assert (wider.drop(sorted(NOISE)).abs() < 0.05).all(), wider
    assert (wider.abs() < 0.1).all(), wider  # of the noise, whose posterior is less Gaussian
    alone = summary(folders["alone"])
    assert alone.loc["slip_stiffness", "sd"] > 1.1 * whole.loc["slip_stiffness", "sd"]
    slip = tomllib.loads((folders["both-1"] / "slip.toml").read_text())
    assert not slip["priors"]["agreement"][0]["conflict"]
