# SPDX-License-Identifier: MIT
"""`[covariates]` states one quantity, by its column or by one value."""

import pytest

from support.rig_tables import columns
from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.covariate import StatedCovariate


def read(folder, text):
    columns(folder, text)
    return read_columns(folder / "columns.toml").covariate


def test_a_column_or_one_value_is_stated(tmp_path):
    stated = read(
        tmp_path / "1", 'covariates.pressure = {name = "P", unit = "kPa", reference = 80}'
    )
    assert stated == StatedCovariate("pressure", "P", None, "kPa", 80.0)
    stated = read(tmp_path / "2", "covariates.temperature = {value = 294}")
    assert stated == StatedCovariate("temperature", None, 294.0, "", None)
    assert read(tmp_path / "3", "source = 'real'") is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a = {value = 1}\nb = {value = 2}", "expected one covariate"),
        ("a = {name = 'A', value = 1}", "expected either the header"),
        ("a = {unit = 'K'}", "expected either the header"),
        ("a = {value = 0}", "expected more than 0"),
        ("a = {value = 1, reference = -3}", "expected more than 0"),
        ("'a b' = {value = 1}", "expected a word of letters"),
        ("a = {value = 1, units = 'K'}", "units"),
        ("a = 3", "a"),
    ],
)
def test_what_cannot_be_meant_is_refused_in_one_line(tmp_path, text, message):
    with pytest.raises(SettingsError, match=message) as raised:
        read(tmp_path, "\n".join(["[covariates]", text]))
    assert "\n" not in str(raised.value)
