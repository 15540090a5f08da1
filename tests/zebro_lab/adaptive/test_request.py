# SPDX-License-Identifier: MIT
from pathlib import Path

import pytest
from typer import BadParameter

from zebro_lab.adaptive.request import AdaptiveRequest
from zebro_lab.files.errors import SettingsError


def test_targets_are_parsed_and_refused_before_anything_moves():
    request = AdaptiveRequest(Path("plan.toml"), "sim", adaptive=("friction=0.01", "walk:run"))
    assert [each.half_width for each in request.wanted] == [0.01, None]
    with pytest.raises(BadParameter):
        AdaptiveRequest(Path("plan.toml"), "sim", adaptive=("friction=none",))


def test_a_budget_belongs_to_adaptive():
    with pytest.raises(SettingsError, match="name a target"):
        AdaptiveRequest(Path("plan.toml"), "sim", budget=100.0)
