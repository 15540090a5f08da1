# SPDX-License-Identifier: MIT
import numpy as np

from support.short_calibration import short_calibration
from zebro_lab.calibration.fitted_blocks import read_fitted_blocks
from zebro_lab.calibration.folder import write_tables


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
