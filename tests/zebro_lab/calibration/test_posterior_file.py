# SPDX-License-Identifier: MIT
"""Laws are drawn from the posterior beside a calibration, or from its Gaussian."""

import dataclasses
from pathlib import Path

import h5py
import numpy as np
import pytest

from model.bayes.likelihood import run_log_likelihood
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.laws import slip_law
from support.short_calibration import short_calibration
from zebro_lab.calibration.folder import POSTERIOR, write_tables
from zebro_lab.calibration.posterior_file import (
    law_draws,
    read_block_means,
    read_slip_blocks,
    slip_tables,
)
from zebro_lab.calibration.slip_argument import NamedSlip, parse_slip
from zebro_lab.files.errors import DataError


def slip_of(folder: Path) -> tuple[NamedSlip, SlipCurve]:
    curve = SlipCurve(
        law=slip_law("brush"), values=np.array([5.0, 0.4]), covariance=np.eye(2) * 1e-3,
        definition=SlipDefinition.MATERIAL, load_range=(1.0, 2.0), slip_range=(0.0, 1.0),
    )  # fmt: skip
    return NamedSlip(curve, "real", "x", (folder / "slip.toml",)), curve


def draw_posterior(folder: Path) -> object:
    slip, curve = slip_of(folder)
    return law_draws(slip, curve, 10, rng=np.random.default_rng(1))


def test_an_assumed_law_has_one_draw(tmp_path):
    slip, curve = slip_of(tmp_path)
    assumed = dataclasses.replace(curve, covariance=np.zeros((2, 2)))
    np.testing.assert_array_equal(
        law_draws(slip, assumed, 7, rng=np.random.default_rng(1)), [curve.values]
    )
    coulomb = parse_slip("coulomb:0.4")
    tables = slip_tables(coulomb, 7, weight=20.0, rng=np.random.default_rng(1))
    assert len(tables) == 1


def test_without_a_posterior_draws_have_the_fitted_mean_and_covariance(tmp_path):
    slip, curve = slip_of(tmp_path)
    draws = law_draws(slip, curve, 20_000, rng=np.random.default_rng(1))
    np.testing.assert_allclose(draws.mean(axis=0), curve.values, atol=1e-3)
    np.testing.assert_allclose(np.cov(draws.T), curve.covariance, atol=5e-5)


@pytest.mark.parametrize("n", [3, 10])
def test_a_posterior_is_drawn_from_row_by_row_and_fixed_parameters_stay(n, tmp_path):
    (tmp_path / "slip.toml").write_text("")
    with h5py.File(tmp_path / POSTERIOR, "w") as data:
        data.create_group("posterior")["friction"] = np.array([0.3, 0.4, 0.5])
    slip, curve = slip_of(tmp_path)
    draws = law_draws(slip, curve, n, rng=np.random.default_rng(1))
    names = [parameter.name for parameter in curve.law.parameters]
    friction = draws[:, names.index("friction")]
    assert set(friction) <= {0.3, 0.4, 0.5}
    assert len(set(friction)) == 3  # all draws are used before one is used again
    np.testing.assert_array_equal(draws[:, names.index("slip_stiffness")], np.full(n, 5.0))


def test_every_draw_of_the_law_has_a_table_of_its_own(tmp_path):
    slip, _ = slip_of(tmp_path)
    tables = slip_tables(slip, 3, weight=20.0, rng=np.random.default_rng(1))
    assert len(tables) == 3
    assert len({table.phi.tobytes() for table in tables}) == 3


def test_block_means_come_back_as_they_were_fitted(tmp_path):
    calibration = short_calibration()
    write_tables(tmp_path, calibration, inputs={})
    blocks = calibration.posterior.blocks
    expected = [blocks.slip, blocks.normal_force, blocks.traction_force]
    np.testing.assert_allclose(read_block_means(tmp_path / "slip.toml"), expected)


def test_without_posterior_there_are_none(tmp_path):
    assert read_block_means(tmp_path / "slip.toml").shape == (3, 0)


def test_blocks_come_back_with_all_that_the_likelihood_takes(tmp_path):
    calibration = short_calibration()
    write_tables(tmp_path, calibration, inputs={})
    blocks, posterior = calibration.posterior.blocks, calibration.posterior
    found = read_slip_blocks(tmp_path / "slip.toml", SlipDefinition.MATERIAL)
    assert found.n_runs == blocks.n_runs
    values = calibration.draws.flat[:3]
    np.testing.assert_allclose(
        run_log_likelihood(found, posterior.law, values),
        run_log_likelihood(blocks, posterior.law, values),
    )


def test_a_calibration_of_an_earlier_version_is_told_apart(tmp_path):
    write_tables(tmp_path, short_calibration(), inputs={})
    with h5py.File(tmp_path / "posterior.nc", "a") as file:
        del file["constant_data"]["slip_wander"]
    with pytest.raises(DataError, match=r"has no slip_wander of its blocks; .* calibrate again"):
        read_slip_blocks(tmp_path / "slip.toml", SlipDefinition.MATERIAL)


def test_blocks_out_of_order_are_refused(tmp_path):
    write_tables(tmp_path, short_calibration(), inputs={})
    with h5py.File(tmp_path / "posterior.nc", "a") as file:
        runs = file["constant_data"]["run"]
        runs[...] = runs[()][::-1]
    with pytest.raises(DataError, match="do not fit together"):
        read_slip_blocks(tmp_path / "slip.toml", SlipDefinition.MATERIAL)
