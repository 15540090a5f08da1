# SPDX-License-Identifier: MIT
"""A weighing with known weights gives the gain its prior."""

import math
from dataclasses import replace

import pytest

from rig.experiment.control import Control
from zebro_lab.experiment.opened_rig import opened_rig
from zebro_lab.experiment.request import WeighRequest
from zebro_lab.experiment.weigh_stage import render_load_cell, weigh_masses
from zebro_lab.files.errors import AlreadyExists, SettingsError


def test_a_weighing_gives_the_gain_its_prior(tmp_path):
    request = WeighRequest("sim", (0.2, 0.5, 1.0), tmp_path, fast=True)
    weighing, check, written = weigh_masses(request, lambda text, normal: None, Control())
    with opened_rig("sim", seed=request.seed, fast=True) as rig:
        gain = rig.truth["rig"]["imperfections"]["gain_normal"]
    assert check.slope == pytest.approx(1 / (1 + gain), abs=1e-4)
    assert len(weighing.forces) == 4
    assert written.read_text() == render_load_cell(check)
    with pytest.raises(AlreadyExists):
        weigh_masses(request, lambda text, normal: None, Control())


@pytest.mark.parametrize("bad", [{"gravity": math.nan}, {"masses": (0.2, math.inf)}])
def test_numbers_that_are_not_finite_are_not_weighed(bad, tmp_path):
    request = replace(WeighRequest("sim", (0.2, 1.0), tmp_path, fast=True), **bad)
    with pytest.raises(SettingsError, match="finite"):
        weigh_masses(request, lambda text, normal: None, Control())
    assert list(tmp_path.iterdir()) == []


def test_masses_in_grams_are_asked_about(tmp_path):
    request = WeighRequest("sim", (200.0, 500.0), tmp_path / "data", fast=True)
    with pytest.raises(SettingsError, match=r"^--masses: a mass of 200 kg .* 200 g is 0\.2$"):
        weigh_masses(request, lambda text, normal: None, Control())
    assert list(tmp_path.iterdir()) == []
