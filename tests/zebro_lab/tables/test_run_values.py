# SPDX-License-Identifier: MIT
"""Each run has one value of the covariate, or the table is refused."""

import numpy as np
import pytest

from support.rig_tables import N, columns, given_slip, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError

STATED = 'covariates.pressure = {name = "P", unit = "kPa"}'


def data(folder, pressure, stated=STATED):
    columns(folder, stated)
    table = given_slip().assign(run=np.repeat([1, 2], N // 2), P=pressure)
    return read_rig_data([write(folder, table)])


def test_the_value_is_the_median_of_the_run(tmp_path):
    pressure = np.repeat([80.0, 60.0], N // 2) + np.tile([-1.0, 0.0, 0.0, 1.0], N // 4)
    found = data(tmp_path, pressure)
    assert found.samples.covariate is not None
    covariate, values = found.samples.covariate
    assert values.tolist() == [80.0, 60.0]
    assert covariate.reference == pytest.approx(np.sqrt(80 * 60))
    np.testing.assert_allclose(covariate.coordinate(values), [1.0, -1.0])
    assert "pressure of runs: 60, 80 kPa" in found.notes


@pytest.mark.parametrize(
    ("pressure", "message"),
    [
        (np.where(np.arange(N) == 5, 0.0, 80.0), "pressure is 0; expected numbers above 0"),
        (np.where(np.arange(N) == 5, np.nan, 80.0), "pressure is nan; expected numbers above 0"),
        (np.linspace(60.0, 80.0, N), r"goes from 60\.\d+ to 69\.\d+ kPa within run 'rig run=1'"),
    ],
)
def test_values_that_no_run_has_are_refused_in_one_line(tmp_path, pressure, message):
    with pytest.raises(DataError, match=message):
        data(tmp_path, pressure)


def test_a_missing_column_names_the_nearest(tmp_path):
    with pytest.raises(DataError, match=r"is missing; .*P.*\[covariates\] pressure"):
        data(tmp_path, 80.0, 'covariates.pressure = {name = "PP"}')


def test_one_value_holds_for_all_runs_of_a_file(tmp_path):
    found = data(tmp_path, 80.0, "covariates.pressure = {value = 70}")
    assert found.samples.covariate is None
    assert "pressure is 70 in all runs: its effect is not testable" in found.notes
