# SPDX-License-Identifier: MIT
"""A request to record names the option whose address has another form."""

from pathlib import Path

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.recording.request import RecordRequest


@pytest.mark.parametrize(
    ("key", "given"),
    [("--zebro", {"zebro": "@sim"}), ("--imu", {"imus": ("sim", "imu@")}), ("--rig", {"rig": "x"})],
)
def test_an_address_of_another_form_names_its_option(key, given):
    with pytest.raises(SettingsError, match=f"^{key}: .*PROFILE@PORT.*replay:RUN"):
        RecordRequest("x", Path("data"), **given)
