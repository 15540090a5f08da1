# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError
from model.gait.reference import LegReference, SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.slip.thesis_curve import thesis_curve
from model.travel import path_length
from model.walk.slip import Slip
from model.walk_models import BASELINES, MODELS, ModelRun, baseline_paths, decides_contact

GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.0), 2.0)
THESIS = Slip(thesis_curve(), "thesis")
T = np.arange(0.0, 4.005, 0.01)


def run(name, *, slip: Slip | None = THESIS, reference: LegReference = GAIT):
    model = MODELS[name]
    return model.run(ModelRun(Robot(), reference, slip if model.slips else None, 4.0, model.dt))


@pytest.mark.parametrize("name", MODELS)
def test_every_model_walks_a_straight_gait_forward(name):
    path = run(name)
    assert path.position[-1, 0] > 0.15
    assert abs(path.yaw[-1] - path.yaw[0]) < np.radians(3)


@pytest.mark.parametrize("name", [name for name, model in MODELS.items() if model.slips])
def test_a_model_that_slips_needs_a_law(name):
    with pytest.raises(DomainError, match="needs a slip law"):
        run(name, slip=None)


def test_baselines_walk_the_same_angles_by_simpler_models():
    paths, notes = baseline_paths(Robot(), SampledReference(T, GAIT.angles(T)), start=5.0)
    assert set(paths) == set(BASELINES)
    assert notes == ()
    for path in paths.values():
        assert path.t[0] == pytest.approx(5.0)
        assert path_length(path) > 0.15


def test_a_model_that_cannot_walk_a_gait_is_left_out_and_said():
    four = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    paths, notes = baseline_paths(Robot(), SampledReference(T, four.angles(T)))
    assert "thesis" not in paths
    assert any("'thesis' cannot walk" in note for note in notes)


TETRAPOD = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)


def test_what_decides_contact_is_named_for_each_model():
    def named(model, reference: LegReference = GAIT, **options):
        return decides_contact(ModelRun(Robot(), reference, THESIS, 1.0, 0.001, **options), model)

    assert [named(model) for model in MODELS] == ["force", "listing", "rest", "rest"]
    assert named("thesis", TETRAPOD) == "events"
    assert named("thesis", SampledReference(T, TETRAPOD.angles(T))) == "listing"
    assert named("thesis", rule="text") == "text"


def test_the_thesis_model_walks_a_tetrapod_by_contact_detection_and_without_a_slip_law():
    path = MODELS["thesis"].run(ModelRun(Robot(), TETRAPOD, None, 3.0, 0.002))
    assert 0.1 < path.length < 0.2
