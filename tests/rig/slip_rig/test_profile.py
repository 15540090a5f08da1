# SPDX-License-Identifier: MIT
"""Profiles of rigs: what cannot be followed is named with its place."""

import pytest

from rig.errors import ProfileError
from rig.profile import shipped_file
from rig.slip_rig.profile import load_rig_profile


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[board]", "[load_cell]", r"either \[drives\] and \[load_cell\], or \[board\]"),
        ("[board]", "[drives]\nrate = 1\n[board]", r"or \[board\], not both"),
        ("radius_leg = 0.035", "radius_leg = 0", "radius_leg: found 0; expected a number above 0"),
        ("normal_sign = 1", "normal_sign = 0", "1 or -1"),
        ("rate = 1000.0", "rates = 1000.0", "rate: is missing"),
        ("speed = 40.0", "speed = 40.0\nspeeed = 1", "did you mean 'speed'"),
    ],
)
def test_a_malformed_rig_profile_is_refused_and_the_place_named(tmp_path, old, new, said):
    text = shipped_file("rig-board-serial.toml").read_text()
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(ProfileError, match=said):
        load_rig_profile(str(path))


def test_two_drives_on_one_node_are_refused(tmp_path):
    text = shipped_file("rig-odrive-netft.toml").read_text()
    path = tmp_path / "mine.toml"
    path.write_text(text.replace("node = 1", "node = 0"))
    with pytest.raises(ProfileError, match="both drives have node 0"):
        load_rig_profile(str(path))


def test_a_load_cell_whose_normal_and_traction_force_share_an_axis_is_refused(tmp_path):
    text = shipped_file("rig-odrive-netft.toml").read_text()
    path = tmp_path / "mine.toml"
    path.write_text(text.replace('axis = "x"', 'axis = "z"'))
    with pytest.raises(
        ProfileError, match=r"load_cell.traction.axis: found 'z', .* load_cell.normal.axis"
    ):
        load_rig_profile(str(path))
