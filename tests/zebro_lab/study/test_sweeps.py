# SPDX-License-Identifier: MIT
"""A replicate of a plan is a simulated sweep on a rig of its own, fitted in blocks."""

import numpy as np

from model.slip.thesis import THESIS_VALUES
from model.study.coverage import RIG
from model.study.ranks import Replicate
from support.study_layouts import design
from zebro_lab.study.sweeps import SweepPlan, SweepStudy, sweep_replicate

PLAN = SweepPlan(slips=tuple(np.linspace(-0.3, 0.6, 6)), loads=(4.0, 10.0), rate=100.0)


def test_a_sweep_is_compared_with_law_and_rig():
    study = SweepStudy(design(), PLAN, 20, {"slip_stiffness": 20.0, "friction": THESIS_VALUES[2]})
    found = sweep_replicate(study, Replicate(1, 0))
    assert found == sweep_replicate(study, Replicate(1, 0))
    assert set(found.held) == {"slip_stiffness", "friction", *RIG}
    other = sweep_replicate(study, Replicate(1, 1))
    assert found.truth["friction"] == other.truth["friction"]
    assert found.truth["gain_traction"] != other.truth["gain_traction"]
