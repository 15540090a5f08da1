# SPDX-License-Identifier: MIT
"""Slip of a rig table: given with its definition, or from the disc speeds."""

from pathlib import Path

import numpy as np
import pytest

from support.bounded_reading import refusal
from support.rig_tables import RADII, N, columns, given_slip, speeds, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError


def test_given_slip_keeps_its_definition(tmp_path):
    data = read_rig_data([write(tmp_path, given_slip("travel"))])
    assert data.samples.definition == "travel"
    assert data.notes[0] == "slip as given in 'slip_ratio', definition travel"


def test_slip_given_without_definition_yields_to_speeds(tmp_path):
    columns(tmp_path, RADII)
    data = read_rig_data([write(tmp_path, speeds().assign(slip_ratio=0.9))])
    assert data.samples.slip.max() == pytest.approx(0.5)
    assert "'slip_ratio' is not used, because its definition is not stated" in data.notes[0]


def test_slip_mapped_with_definition_wins_over_speeds(tmp_path):
    columns(tmp_path, "columns.slip_ratio = { name = 'SL', definition = 'travel' }\n" + RADII)
    table = speeds().assign(SL=np.linspace(0, 0.1, N))
    data = read_rig_data([write(tmp_path, table)])
    assert data.samples.slip.max() == pytest.approx(0.1)
    assert "columns of disc speeds are not used" in data.notes[0]


def test_measured_slip_may_pass_its_limit_by_noise(tmp_path):
    table = given_slip("material").assign(slip_ratio=np.linspace(0, 1.02, N))
    assert read_rig_data([write(tmp_path, table)]).samples.slip.max() == pytest.approx(1.02)


def test_definition_stated_differently_in_map_and_file_is_refused(tmp_path):
    columns(tmp_path, "columns.slip_ratio.definition = 'travel'")
    path = write(tmp_path, given_slip("material"))
    with pytest.raises(
        DataError, match="slip definition is 'material' in this column and 'travel' in"
    ):
        read_rig_data([path])


def refused_as_travel(folder: Path, slip: float) -> tuple[Path, str]:
    """Write a slip ratio into row 8; return the file and the error of converting it."""
    table = given_slip("material")
    table.loc[7, "slip_ratio"] = slip
    path = write(folder, table)
    return path, refusal(lambda file: read_rig_data([file], slip_definition="travel"), path)


def test_slip_outside_what_conversion_allows_names_file_and_row(tmp_path):
    path, message = refused_as_travel(tmp_path, 1.05)
    assert message.startswith(f"{path}, column 'slip_ratio', row 8 (line 9): the slip ratio 1.05 ")


def test_slip_infinite_in_the_asked_definition_names_the_row(tmp_path):
    _, message = refused_as_travel(tmp_path, 1.0)
    assert (
        "row 8 (line 9): the 'material' slip ratio 1 is infinite in the definition 'travel'"
        in message
    )
