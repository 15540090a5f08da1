# SPDX-License-Identifier: MIT
"""Profiles of rigs: what cannot be followed is named with its place."""

from importlib import resources

import pytest

from rig.slip_rig.profile import Zero, load_rig_profile
from support.malformed_profiles import require_refused

BOARD, DRIVES = "rig-board-serial", "rig-odrive-netft"


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        (BOARD, "[board]", "[load_cell]", "either [drives] and [load_cell], or [board]"),
        (BOARD, "[board]", "[drives]\nrate = 1\n[board]", "or [board], not both"),
        (BOARD, "radius_leg = 0.035", "radius_leg = 0", "radius_leg: found 0; expected"),
        (BOARD, "normal_sign = 1", "normal_sign = 0", "1 or -1"),
        (BOARD, "rate = 1000.0", "rates = 1000.0", "rate: is missing"),
        (BOARD, "speed = 40.0", "speed = 40.0\nspeeed = 1", "did you mean 'speed'"),
        (BOARD, "[board]", "[unloaded]\nnormal = 0\n[board]", "unloaded.traction: is missing"),
        (DRIVES, "node = 1", "node = 0", "both drives have node 0"),
        (DRIVES, 'axis = "x"', 'axis = "z"', "load_cell.traction.axis: found 'z'"),
    ],
)  # fmt: skip
def test_a_malformed_profile_is_refused_and_the_place_named(tmp_path, name, old, new, said):
    require_refused(load_rig_profile, tmp_path, name, old, new, said)


def test_a_profile_states_what_the_cell_reads_without_load(tmp_path):
    file = tmp_path / "own.toml"
    unloaded = "[unloaded]\nnormal = 0.2\ntraction = -0.1\nstandard_error = 0.25\n"
    text = (resources.files("rig") / "profiles" / f"{DRIVES}.toml").read_text()
    file.write_text(text + unloaded)
    assert load_rig_profile(str(file)).unloaded == Zero(0.2, -0.1, 0.25)
    assert load_rig_profile(DRIVES).unloaded is None
