# SPDX-License-Identifier: MIT
"""Walks inform legs and floor, and a walk is predicted from what others said."""

import numpy as np
import pytest

from model.bayes.walks.prior import WalkPrior
from model.errors import ModelError
from support.judged_walks import judged_walk
from support.tracked_walks import write_walk
from support.walk_posteriors import posterior_of
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.walk_fit import prediction
from zebro_lab.walk_fit.prediction import (
    fit_and_leave_out,
    fit_walks_on_file,
    judge_from,
    predict_from,
)
from zebro_lab.walk_fit.tracked_walks import read_walk_on_file


def test_no_walks_are_refused_as_the_model_refuses_them():
    with pytest.raises(ModelError, match="no walk to fit"):
        fit_walks_on_file([], parse_slip("thesis"), prior=WalkPrior(), rng=np.random.default_rng(1))


SLIP = parse_slip("coulomb:0.38")


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walks") / "one"
    return read_walk_on_file(write_walk(folder))


def test_a_walk_is_predicted_from_a_posterior_without_its_track(walk):
    rng = np.random.default_rng(1)
    found = predict_from(posterior_of(None), walk, SLIP, rng=rng, draws=4)
    path, band = found.prediction.path, found.prediction.draws
    assert (path.t[0], path.t[-1]) == (0.0, pytest.approx(walk.duration))
    assert band.position.shape == (4, len(path), 2)
    np.testing.assert_allclose(path.states[0], 0.0, atol=1e-12)
    assert 0.5 < path.length < 1.5
    assert {"no-slip", "no-slip-simple"} <= set(found.prediction.baselines)
    assert found.files == walk.files
    judged = judge_from(posterior_of(None), walk, SLIP, rng=rng, draws=4)
    assert judged.name == walk.name
    assert judged.rows[0].name == "prediction"


def test_a_wrong_leg_of_the_posterior_turns_the_predicted_path(walk):
    def end(posterior):
        rng = np.random.default_rng(1)
        found = predict_from(posterior, walk, SLIP, rng=rng, draws=2)
        return found.prediction.path.yaw[-1]

    steered = end(posterior_of(None, steering=0.1)) - end(posterior_of(None))
    assert steered == pytest.approx(0.1 * 1.0, rel=0.2)


def test_all_walks_are_fitted_and_each_is_predicted_from_the_others(walk, monkeypatch):
    asked = []

    class Fit:
        posterior = posterior_of(None)

        def without(self, index):
            asked.append(index)
            return self.posterior

    monkeypatch.setattr(prediction, "fit_walks", lambda *_, **__: Fit())
    monkeypatch.setattr(
        prediction, "judge_from", lambda _, walk, *__, **___: judged_walk(walk.name, off=0.02)
    )
    seen = []
    given = {"prior": WalkPrior(), "rng": np.random.default_rng(1), "progress": seen.append}
    alone = fit_and_leave_out([walk], SLIP, **given)
    assert (alone.left_out, asked) == ((), [])
    assert fit_walks_on_file([walk], SLIP, **given).posterior is Fit.posterior
    both = fit_and_leave_out([walk, walk], SLIP, **given)
    assert asked == [0, 1]
    assert [run.name for run in both.left_out] == [walk.name] * 2
    assert seen == sorted(seen)
