# SPDX-License-Identifier: MIT
"""Plans on disk: what cannot be followed is named with file and key."""

import pytest

from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.files.errors import SettingsError


def test_an_unknown_key_names_file_key_and_the_nearest(plan):
    plan.write_text(plan.read_text().replace("acceleration =", "aceleration ="))
    with pytest.raises(SettingsError, match=r"plan\.toml, limits\.acceleration: is missing"):
        read_plan(plan)
    plan.write_text(plan.read_text() + "acceleration = 40.0\n")
    with pytest.raises(SettingsError, match="aceleration: unknown key; did you mean 'accelera"):
        read_plan(plan)
