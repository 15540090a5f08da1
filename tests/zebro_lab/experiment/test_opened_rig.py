# SPDX-License-Identifier: MIT
"""The rig of an experiment by its address, real or simulated."""

import pytest

from rig.errors import ProfileError
from rig.experiment.control import Control
from rig.experiment.load import HandShaft, SimulatedOperator
from rig.experiment.plan import LoadSetting
from zebro_lab.experiment.opened_rig import TWIN_PROFILE, opened_rig
from zebro_lab.files.errors import SettingsError

HAND = LoadSetting("hand", tolerance=0.3, patience=30.0)


def test_a_fast_twin_passes_its_own_time_and_knows_its_truth():
    with opened_rig("sim", fast=True) as rig:
        before = rig.clock.now()
        rig.clock.sleep(3600.0)
        assert rig.clock.now() == before + 3600.0
        assert rig.fast
        assert rig.truth["rig"]["law"] == "magic-formula"
        assert rig.profiles["rig"][0] == TWIN_PROFILE
        assert {stream.name for stream in rig.bench.streams} == {"board"}
        profile = rig.bench.profile
        assert rig.constants == {
            "radius_leg": profile.radius_leg, "radius_ground": profile.radius_ground,
        }  # fmt: skip


def test_each_seed_is_a_rig_of_its_own_and_one_seed_the_same_again():
    truths = []
    for seed in (1, 1, 2):
        with opened_rig("sim", seed=seed, fast=True) as rig:
            truths.append(rig.truth)
    assert truths[0] == truths[1] != truths[2]


def test_drives_and_load_cell_have_views_of_their_own():
    with opened_rig("rig-odrive-netft@sim") as rig:
        assert {stream.name for stream in rig.bench.streams} == {"drives", "load_cell"}
        assert rig.twin is not None


def test_a_real_rig_has_a_person_at_its_shaft():
    with opened_rig("rig-board-serial@/dev/null") as rig:
        assert (rig.twin, rig.fast, rig.truth) == (None, False, {})
        assert isinstance(rig.load_setter(HAND, Control()), HandShaft)


def test_a_twin_has_an_operator():
    with opened_rig("sim", fast=True) as rig:
        assert isinstance(rig.load_setter(HAND, Control()), SimulatedOperator)


@pytest.mark.parametrize(("address", "error", "said"), [
    ("rig-board-serial@/dev/null", SettingsError, "works only with a simulated rig"),
    ("rig-odrive-netft@sim", SettingsError, "runs in real time only"),
    ("replay:RUN", ProfileError, "replays a recording"),
])  # fmt: skip
def test_what_cannot_be_fast_says_so(address, error, said):
    with pytest.raises(error, match=said), opened_rig(address, fast=True):
        pass
