# SPDX-License-Identifier: MIT
"""By commands: last year's half as the prior of this year's half is all data; widened, less."""

import shutil
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.bayes.blocks import block_means
from model.bayes.checks.faults import NOISE
from model.bayes.fit import scaled_load_cell
from model.bayes.likelihood import NUISANCE
from model.bayes.posterior import default_priors
from model.slip.thesis import THESIS_LAW
from support.calibrate_processes import calibrate_slip
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.rig_data import read_rig_data

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]

RIG = Path(__file__).parents[2] / "datasets" / "rig-sim"
FIT = ("--block-length", "48", "--curvature", "peak")
SEEDS = (1, 2)
"""Of a fit's 4,000 draws a spread is known to 1.3 %, and three fits enter a comparison."""
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
    fits = {"alone": (base / "this",)}
    for seed in SEEDS:
        earlier = base / f"fit-last-{seed}"
        fits |= {
            f"last-{seed}": (base / "last", "--seed", seed),
            f"all-{seed}": (RIG, "--seed", seed),
            f"both-{seed}": (base / "this", "--prior-from", earlier, "--seed", seed),
        }
    fits["widened"] = (base / "this", "--prior-from", base / "fit-last-1", "--widen", 2)
    for name, arguments in fits.items():
        ended = calibrate_slip(*arguments, *FIT, "--out", base / f"fit-{name}")
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


def draws(folder: Path) -> np.ndarray:
    found, _ = read_draws_of(folder / "posterior.nc", "posterior", NAMES, advice="")
    return np.column_stack([found[name] for name in NAMES])


def test_a_widened_prior_gives_what_the_product_of_densities_gives(folders):
    """Gaussians in the default priors' coordinates: this year's without its prior, last year's."""
    data = read_rig_data([folders["data"]])
    cell = scaled_load_cell(data.samples, data.load_cell)
    base = default_priors(THESIS_LAW, block_means(data.samples, 48), cell, data.rig_errors)

    def gaussian(name: str) -> tuple[np.ndarray, np.ndarray]:
        values = draws(folders[name])
        z = np.column_stack([base[n].coordinate(values[:, i]) for i, n in enumerate(NAMES)])
        return z.mean(axis=0), np.cov(z.T)

    (last, last_covariance), (alone, alone_covariance) = gaussian("last-1"), gaussian("alone")
    widened = np.linalg.inv(4 * last_covariance)
    fitted = np.linalg.inv(alone_covariance)
    covariance = np.linalg.inv(fitted - np.eye(len(NAMES)) + widened)
    mean = covariance @ (fitted @ alone + widened @ last)
    found, found_covariance = gaussian("widened")
    sd = np.sqrt(np.diag(covariance))
    off, wider = (found - mean) / sd, np.sqrt(np.diag(found_covariance)) / sd - 1
    print(dict(zip(NAMES, zip(off.round(3), wider.round(3), strict=True), strict=True)))  # noqa: T201
    noise = np.isin(NAMES, sorted(NOISE))  # whose posterior is less Gaussian than the product
    assert (np.abs(off)[~noise] < 0.15).all()
    assert (np.abs(wider)[~noise] < 0.1).all()
    assert (np.abs(off)[noise] < 0.25).all()
    assert (np.abs(wider)[noise] < 0.25).all()
    _, both_covariance = gaussian("both-1")
    assert found_covariance[0, 0] > 1.1 * both_covariance[0, 0]  # of the slip stiffness
