# SPDX-License-Identifier: MIT
"""Walks inform legs and floor, and a walk is predicted from what others said."""

from dataclasses import replace

import numpy as np
import pytest

from model.errors import ModelError
from model.gait.reference import SampledReference
from model.walk_fit.prior import WalkPrior
from model.walk_fit.tracked_walk import middle
from support.tracked_walks import write_walk
from support.walk_posteriors import posterior_of
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.walk_fit import prediction
from zebro_lab.walk_fit.prediction import (
    fit_walks_on_file,
    judge_left_out,
    predict_from,
)
from zebro_lab.walk_fit.tracked_walks import read_walk_on_file


def test_no_walks_are_refused_as_the_model_refuses_them():
    with pytest.raises(ModelError, match="no walk was given"):
        fit_walks_on_file([], parse_slip("thesis"), prior=WalkPrior(), rng=np.random.default_rng(1))


SLIP = parse_slip("coulomb:0.38")


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walks") / "one"
    return read_walk_on_file(write_walk(folder))


@pytest.fixture(autouse=True)
def few_draws(monkeypatch):
    """Draw four paths a band; they take most of the time."""
    monkeypatch.setattr(prediction, "DRAWS", 4)


def test_a_walk_is_predicted_from_a_posterior_without_its_track(walk):
    rng = np.random.default_rng(1)
    found = predict_from(posterior_of(None), walk, SLIP, rng=rng)
    path, band = found.prediction.path, found.prediction.draws
    assert (path.t[0], path.t[-1]) == (0.0, pytest.approx(walk.duration))
    assert band.position.shape == (4, len(path), 2)
    np.testing.assert_allclose(path.states[0], 0.0, atol=1e-12)
    assert 0.5 < path.length < 1.5
    assert {"no-slip", "no-slip-simple"} <= set(found.prediction.baselines)
    assert found.files == walk.files


def test_steering_of_the_posterior_turns_the_predicted_path(walk):
    def end(posterior):
        found = predict_from(posterior, walk, SLIP, rng=np.random.default_rng(1))
        return found.prediction.path.yaw[-1]

    steered = end(posterior_of(None, steering=0.1)) - end(posterior_of(None))
    assert steered == pytest.approx(0.1 * 1.0, rel=0.2)


def test_offsets_of_the_legs_count_once_in_the_baselines(walk):
    true = middle(walk.legs)
    offset = np.radians([8.0, 0.0, 0.0, -5.0, 0.0, 0.0])
    robot = replace(walk.robot.robot, leg_offset=offset)
    reported = SampledReference(walk.legs.t, true.angles(walk.legs.t) - offset)

    def baseline(robot, legs):
        named = replace(walk, robot=replace(walk.robot, robot=robot), legs=legs)
        found = predict_from(posterior_of(None), named, SLIP, rng=np.random.default_rng(1))
        return found.prediction.baselines["no-slip"].states

    exact = SampledReference(walk.legs.t, true.angles(walk.legs.t))
    expected = baseline(walk.robot.robot, exact)
    np.testing.assert_allclose(baseline(robot, reported), expected, atol=1e-6)


class Fit:
    """A fit of walks that keeps which of them were left out."""

    def __init__(self) -> None:
        self.posterior = posterior_of(None)
        self.asked: list[int] = []

    def without(self, index: int):
        self.asked.append(index)
        return self.posterior


def test_all_walks_are_fitted_by_the_model(walk, monkeypatch):
    fit = Fit()
    monkeypatch.setattr(prediction, "fit_walks", lambda *_, **__: fit)
    given = {"prior": WalkPrior(), "rng": np.random.default_rng(1)}
    assert fit_walks_on_file([walk], SLIP, **given) is fit


def test_each_walk_is_predicted_from_the_others_and_one_alone_is_not(walk):
    fit, seen, rng = Fit(), [], np.random.default_rng(1)
    assert judge_left_out(fit, [walk], SLIP, rng=rng) == ()
    assert fit.asked == []
    both = judge_left_out(fit, [walk, walk], SLIP, rng=rng, progress=seen.append)
    assert fit.asked == [0, 1]
    assert [run.name for run in both] == [walk.name] * 2
    assert both[0].rows[0].name == "prediction"
    assert seen == [0.0, 0.5]
