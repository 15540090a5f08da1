# SPDX-License-Identifier: MIT
"""By commands: last year's half as the prior of this year's half is all data; widened, less."""

import shutil
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy import stats
from scipy.special import logsumexp

from model.bayes.blocks import block_means
from model.bayes.likelihood import NUISANCE
from model.bayes.posterior import LoadCell, default_priors
from model.slip.thesis import THESIS_LAW
from support.calibrate_processes import calibrate_slip
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.rig_data import read_rig_data

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]

RIG = Path(__file__).parents[2] / "datasets" / "rig-sim"
FIT = ("--block-length", "48", "--curvature", "peak", "--ensembles", "8")
"""Twice the usual draws: with 4,000 a spread is known to 1.1 %, and three enter a comparison."""
NOISE = ("noise_floor", "noise_slope", "noise_correlation", "offset_spread")
NAMES = [p.name for p in (*THESIS_LAW.parameters, *NUISANCE)]


@pytest.fixture(scope="module")
def folders(tmp_path_factory) -> dict[str, Path]:
    """Fit both halves of the runs, all of them, and this year's with last year's as prior."""
    base = tmp_path_factory.mktemp("halves")
    for half, year in enumerate(("last", "this")):
        (base / year).mkdir()
        for table in RIG.glob("*.parquet"):
            rows = pd.read_parquet(table)
            rows[rows["run"] % 2 == half].to_parquet(base / year / table.name)
        shutil.copy(RIG / "columns.toml", base / year)
    fits = {
        "last": (base / "last",), "alone": (base / "this",), "all": (RIG,),
        "both": (base / "this", "--prior-from", base / "fit-last"),
        "widened": (base / "this", "--prior-from", base / "fit-last", "--widen", 2),
    }  # fmt: skip
    for name, arguments in fits.items():
        ended = calibrate_slip(*arguments, *FIT, "--out", base / f"fit-{name}")
        assert ended.returncode == 0, ended.stderr
    return {name: base / f"fit-{name}" for name in fits} | {"data": base / "this"}


def summary(folder: Path) -> pd.DataFrame:
    return pd.read_csv(folder / "summary.csv", index_col="parameter")


def test_the_halves_together_are_all_data(folders):
    both, whole, alone = (summary(folders[name]) for name in ("both", "all", "alone"))
    off = (both["mean"] - whole["mean"]) / whole["sd"]
    wider = both["sd"] / whole["sd"] - 1
    assert (off.abs() < 0.2).all()
    curve_and_cell = wider.drop(list(NOISE))
    assert (curve_and_cell.abs() < 0.05).all()
    assert (wider.abs() < 0.1).all()  # of the noise, whose posterior is less Gaussian
    assert alone.loc["slip_stiffness", "sd"] > 1.1 * whole.loc["slip_stiffness", "sd"]
    slip = tomllib.loads((folders["both"] / "slip.toml").read_text())
    assert not slip["priors"]["agreement"][0]["conflict"]


def draws(folder: Path) -> np.ndarray:
    found, _ = read_draws_of(folder / "posterior.nc", "posterior", NAMES, advice="")
    return np.column_stack([found[name] for name in NAMES])


def test_a_widened_prior_gives_what_the_product_of_densities_gives(folders):
    """This year's draws, weighted by the widened Gaussian over their own prior."""
    samples = read_rig_data([folders["data"]]).samples
    cell = LoadCell(zero_stability=0.1, gain_sd=0.005, bias_sd=0.05, crosstalk_sd=0.005)
    base = default_priors(THESIS_LAW, block_means(samples, 31), cell)

    def coordinates(values: np.ndarray) -> np.ndarray:
        return np.column_stack([base[n].coordinate(values[:, i]) for i, n in enumerate(NAMES)])

    last, alone = coordinates(draws(folders["last"])), coordinates(draws(folders["alone"]))
    prior = stats.multivariate_normal(last.mean(axis=0), 4 * np.cov(last.T))
    ratio = prior.logpdf(alone) - stats.norm.logpdf(alone).sum(axis=1)
    weights = np.exp(ratio - logsumexp(ratio))
    widened = coordinates(draws(folders["widened"]))
    effective = 1 / np.sum(weights**2)
    assert effective > 150
    mean = weights @ alone
    sd = np.sqrt(weights @ (alone - mean) ** 2)
    off, wider = (widened.mean(axis=0) - mean) / sd, widened.std(axis=0) / sd - 1
    assert (np.abs(off) < 4 / np.sqrt(effective)).all()
    assert (np.abs(wider) < 4 / np.sqrt(2 * effective)).all()
