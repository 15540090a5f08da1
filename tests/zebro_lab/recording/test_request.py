# SPDX-License-Identifier: MIT
"""A request to record names the option whose address has another form."""

from pathlib import Path

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.recording.request import RecordRequest, require_address


@pytest.mark.parametrize(
    ("key", "given"),
    [("--zebro", {"zebro": "@sim"}), ("--imu", {"imus": ("sim", "imu@")}), ("--rig", {"rig": "x"})],
)
def test_an_address_of_another_form_names_its_option(key, given):
    with pytest.raises(SettingsError, match=f"^{key}: .*PROFILE@PORT.*replay:RUN"):
        RecordRequest("x", Path("data"), **given)


@pytest.mark.parametrize("address", ["sim", "zebro-100-serial@sim", "a@socket://b:1@c"])
def test_addresses_of_devices_pass(address):
    require_address(address, key="--zebro")


@pytest.mark.parametrize("address", ["", "zebro", "@sim", "zebro@", "replay:run", "SIM"])
def test_another_form_names_the_option_and_what_is_expected(address):
    with pytest.raises(SettingsError, match=r"^--zebro: .*PROFILE@PORT.*, or sim$"):
        require_address(address, key="--zebro")


def test_a_replay_passes_only_where_it_can_be_used_and_names_a_run():
    require_address("replay:data/RUN", key="--imu", replay=True)
    with pytest.raises(SettingsError, match="or sim or replay:RUN"):
        require_address("replay:", key="--imu", replay=True)
