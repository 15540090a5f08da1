# SPDX-License-Identifier: MIT
"""Addresses of another form name the option."""

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.recording.address_argument import require_address


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
