# SPDX-License-Identifier: MIT
"""Two materials scatter friction between runs; a zero of the load cell scatters force."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.scatter import friction_scatter
from support.linearised_fits import linearised, with_force

RNG = np.random.default_rng(2)
HALF_OF_THEM = RNG.random(48) < 0.5


def scatter(change=None):
    _, fit, _ = linearised(*([change] if change else []))
    found = friction_scatter(fit, np.zeros(len(fit.blocks)))
    assert found is not None
    return found


@pytest.mark.parametrize("size", [0.1, 0.4])
def test_runs_on_a_second_material_are_found(size):
    found = scatter(
        lambda s: replace(
            s, traction_force=s.traction_force * np.where(HALF_OF_THEM[s.run], 1 - size, 1)
        )
    )
    assert found.p < 1e-4
    assert found.sd == pytest.approx(size * np.sqrt(0.5), rel=0.5)


def test_a_sound_rig_and_one_whose_zero_scatters_have_one_friction():
    assert scatter().p > 1e-3
    zeros = RNG.normal(0.0, 0.2, 48)
    assert scatter(with_force(lambda s: zeros[s.run])).p > 1e-3


def test_what_is_explained_already_is_not_taken_for_a_second_material():
    _, fit, _ = linearised(with_force(lambda s: -0.1 * s.traction_force * (s.slip < 0)))
    explained = 0.1 * np.abs(fit.predicted.force) * (fit.blocks.slip < 0)
    before = friction_scatter(fit, np.zeros(len(fit.blocks)))
    after = friction_scatter(fit, explained)
    assert before is not None
    assert after is not None
    assert before.p < 1e-4 < after.p
