# SPDX-License-Identifier: MIT
"""The thesis's model walks tripods and logs by its dynamics, other gaits without slip."""

import numpy as np
import pytest

from model.errors import DomainError
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.thesis.model import is_kinematic, walk_by_thesis

TRIPOD = tripod_reference(tripod_angles(np.radians(45.0), 1.2), 1.0, direction="left")
TIMES = np.arange(0.0, 2.0, 0.01)
LOG = SampledReference(TIMES, TRIPOD.angles(TIMES))


def walk(reference):
    return walk_by_thesis(Robot(), reference, None, duration=1.0, dt=0.001)


def test_a_gait_that_is_no_tripod_walks_without_a_slip_law():
    tetrapod = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    assert is_kinematic(tetrapod)
    assert np.isfinite(walk(tetrapod).position).all()


@pytest.mark.parametrize("reference", [TRIPOD, LOG])
def test_a_tripod_or_a_log_without_a_slip_law_is_refused(reference):
    assert not is_kinematic(reference)
    with pytest.raises(DomainError, match="slip law"):
        walk(reference)
