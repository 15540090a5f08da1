# SPDX-License-Identifier: MIT
"""Options of a calibration, as the fit takes them."""

from pathlib import Path
from typing import get_type_hints

import pytest

from model.bayes.calibrate import FIRST_LOOK
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.files.errors import SettingsError


def test_what_is_read_are_the_data_and_the_column_map():
    data, columns = Path("data"), Path("columns.toml")
    assert CalibrationRequest((data,)).inputs == (data,)
    assert CalibrationRequest((data,), columns=columns).inputs == (data, columns)


def test_the_help_states_the_fewest_moves_of_a_fit():
    option = get_type_hints(CalibrationRequest, include_extras=True)["max_steps"].__metadata__[0]
    assert f"first look at {FIRST_LOOK} moves" in option.help


def test_the_earlier_calibration_is_read_and_its_options_need_it():
    earlier = Path("last-year")
    assert CalibrationRequest(prior_from=earlier).inputs == (earlier,)
    with pytest.raises(SettingsError, match="belongs to --prior-from"):
        CalibrationRequest(carry="law")
    with pytest.raises(SettingsError, match="is no prior"):
        CalibrationRequest(prior=("friction 0.4",))
