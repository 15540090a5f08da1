# SPDX-License-Identifier: MIT
"""Calibrations that tests of plots share."""

from dataclasses import replace

import numpy as np
import pytest

from model.slip import MagicFormula, SlipDefinition
from support.calibration_scenes import RIG_LOADS, Scene, scene


@pytest.fixture(scope="module")
def rig() -> Scene:
    truth = [20.4, 1.564, 0.3798, 0.0066]
    return scene(MagicFormula(), truth, np.linspace(0, 1, 62), RIG_LOADS, 0.05)


@pytest.fixture(scope="module")
def one_load() -> Scene:
    truth = [20.4, 1.564, 0.3798, 0.0066]
    return scene(MagicFormula(), truth, np.linspace(0, 1, 62), RIG_LOADS[1:2], 0.05)


@pytest.fixture(scope="module")
def tyre() -> Scene:
    law = MagicFormula("constant", load_sensitivity=True, reference_load=1500.0)
    slip = 0.15 * np.sin(np.linspace(0, 20, 300))
    truth, loads = [22.0, 1.5, 1.1, -0.8, -0.1, 0.05], np.array([500.0, 1000.0, 2000.0, 3000.0])
    return scene(law, truth, slip, loads, 40.0, SlipDefinition.TRAVEL)


@pytest.fixture(scope="module")
def few() -> Scene:
    truth = [20.4, 1.564, 0.3798, 0.0066]
    crowd = scene(
        MagicFormula(), truth, np.linspace(0.05, 0.9, 9), np.array([2.0, 6.0, 12.0]), 0.05
    )
    return replace(crowd, blocks=replace(crowd.blocks, run=np.arange(27)))


@pytest.fixture(params=["rig", "one_load", "tyre", "few"])
def any_scene(request: pytest.FixtureRequest) -> Scene:
    return request.getfixturevalue(request.param)
