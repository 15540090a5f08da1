# SPDX-License-Identifier: MIT
import h5py
import numpy as np
import pytest

from model.bayes.likelihood import run_log_likelihood
from model.slip.definition import SlipDefinition
from support.short_calibration import short_calibration
from zebro_lab.calibration.fitted_blocks import read_fitted_blocks, read_slip_blocks
from zebro_lab.calibration.folder import write_tables
from zebro_lab.files.errors import DataError


def test_block_means_come_back_as_they_were_fitted(tmp_path):
    calibration = short_calibration()
    write_tables(tmp_path, calibration, inputs={})
    found, blocks = (
        read_fitted_blocks(tmp_path / "slip.toml", "material"), calibration.posterior.blocks
    )  # fmt: skip
    np.testing.assert_allclose(found.slip, blocks.slip)
    np.testing.assert_allclose(found.normal_force, blocks.normal_force)
    np.testing.assert_allclose(found.traction_force, blocks.traction_force)


def test_without_posterior_there_are_none(tmp_path):
    assert read_fitted_blocks(tmp_path / "slip.toml", "material") is None


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
