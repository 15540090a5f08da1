# SPDX-License-Identifier: MIT
"""Profiles choose drivers and links; profiles of tables choose none."""

from types import SimpleNamespace

import pytest

from rig.backends import leg_driver, leg_link, open_imu, open_legs, open_rig
from rig.clock import ManualClock
from rig.driver_table import LEGS
from rig.errors import ProfileError
from rig.imu.profile import render_table_profile
from rig.links.byte_link import MemoryLink
from rig.links.can import CanLink
from rig.links.serial import SerialLink
from rig.zebro.profile import load_leg_profile
from support.table_runs import table_profile

OF_LAYOUT = {
    "packet": "zebro-100-serial", "can": "zebro-100-can", "dump": "vregs-dump",
    "poll": "zebrobus-uart",
}  # fmt: skip


@pytest.mark.parametrize("layout", OF_LAYOUT)
def test_the_layout_chooses_the_driver(layout):
    profile = load_leg_profile(OF_LAYOUT[layout])
    clock = ManualClock()
    driver = leg_driver(
        profile, MemoryLink(SimpleNamespace(source="sim:none"), clock=clock), clock=clock
    )
    assert LEGS[layout].driver.endswith(f":{type(driver).__name__}")
    assert (driver.name, driver.profile) == ("legs", profile)


def test_the_layout_chooses_the_link():
    links = {"packet": SerialLink, "can": CanLink}
    for layout, kind in links.items():
        link = leg_link(load_leg_profile(OF_LAYOUT[layout]), "virtual:x", source="sim:zebro")
        assert isinstance(link, kind)
        assert link.source == "sim:zebro"


def test_a_rig_is_a_board_or_drives_and_a_load_cell():
    devices = open_rig("rig-odrive-netft@virtual:x")
    assert [stream.name for stream in devices.streams] == ["drives", "load_cell"]
    board = open_rig("rig-board-serial@/dev/null")
    assert [stream.name for stream in board.streams] == ["board"]
    assert open_imu("imu-quaternion-serial@/dev/null", name="imu1").name == "imu1"
    legs = open_legs("zebro-100-serial@/dev/null")
    assert (legs.name, legs.source) == ("legs", "real")


def test_a_profile_of_a_table_opens_nothing(tmp_path):
    imu, rig = tmp_path / "imu.toml", tmp_path / "rig.toml"
    imu.write_text(render_table_profile(100.0))
    rig.write_text(table_profile())
    for opener, file in ((open_imu, imu), (open_rig, rig)):
        with pytest.raises(ProfileError, match="describes a file, not a device"):
            opener(f"{file}@/dev/null")
