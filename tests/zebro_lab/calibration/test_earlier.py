# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from support.compared_folders import calibration
from support.short_calibration import short_calibration
from zebro_lab.calibration.earlier import read_earlier
from zebro_lab.calibration.folder import write_tables
from zebro_lab.files.errors import NotFound


def test_draws_law_and_block_length_are_those_of_the_calibration(tmp_path):
    fitted = short_calibration()
    write_tables(tmp_path, fitted, inputs={})
    found = read_earlier(tmp_path)
    assert found.curve.law == fitted.posterior.law
    assert found.block_length == fitted.fit.block_choice.length
    assert found.title == tmp_path.name
    names = [p.name for p in fitted.posterior.parameters]
    for name, draws in found.draws.items():
        np.testing.assert_allclose(draws, fitted.draws.flat[:, names.index(name)])
    assert len(found.draws) == len(names)


def test_simulated_and_untrustworthy_priors_are_said(tmp_path):
    write_tables(tmp_path, short_calibration(), inputs={})
    warned, simulated = read_earlier(tmp_path).notes
    assert "not trustworthy: NOT CONVERGED" in warned
    assert "SIMULATED data, source 'sim:test'" in simulated


def test_a_slip_toml_without_draws_is_no_posterior(tmp_path):
    with pytest.raises(NotFound, match=r"posterior\.nc: no such file"):
        read_earlier(calibration(tmp_path / "slip"))
