# SPDX-License-Identifier: MIT
"""A sweep tests every slip ratio at every load; an impossible one is refused."""

import numpy as np
import pytest

from model.errors import DomainError
from rig.slip_rig.sweep import SweepPlan


def test_the_default_plan_is_the_sources_62_slips_at_4_loads():
    plan = SweepPlan()
    assert (len(plan.slips), plan.slips[0], plan.slips[-1]) == (62, 0.0, 1.0)
    np.testing.assert_allclose(np.diff(plan.slips), 1 / 61)
    assert (plan.n_runs, plan.n_samples) == (248, 250)


def test_runs_are_ordered_by_load_then_slip():
    plan = SweepPlan(slips=(0.0, 0.5), loads=(2.0, 1.0), duration=0.02, rate=100)
    load, slip = plan.set_points()
    assert load.tolist() == [2.0, 2.0, 1.0, 1.0]
    assert slip.tolist() == [0.0, 0.5, 0.0, 0.5]
    assert plan.run_names()[1] == "Fn 2 N, slip 0.5000"


@pytest.mark.parametrize(
    ("fault", "named"),
    [
        ({"loads": (2.0, -1.0)}, "loads is -1"),
        ({"slips": (0.0, 1.5)}, "slips is 1.5"),
        ({"rate": 0.0}, "rate is 0"),
        ({"radius_ground": float("nan")}, "radius_ground is nan"),
        ({"duration": 0.004}, "at least 2 samples"),
    ],
)
def test_an_impossible_plan_is_refused_by_name_and_value(fault, named):
    with pytest.raises(DomainError, match=named):
        SweepPlan(**fault)
