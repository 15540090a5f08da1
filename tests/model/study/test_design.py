# SPDX-License-Identifier: MIT
"""A study draws its truth from the priors of its fit, where these allow a curve."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.priors import Normal
from model.errors import FitError
from model.slip.thesis import THESIS_LAW
from model.study.design import StudyDesign
from support.study_layouts import design, layout


def test_draws_follow_the_priors():
    study = design()
    draws = np.array([study.draw(np.random.default_rng([1, i])) for i in range(400)])
    names = list(study.named(draws[0]))
    for name in ("gain_traction", "rolling_resistance", "noise_slope"):
        z = study.priors[name].coordinate(draws[:, names.index(name)])
        assert abs(z.mean()) < 0.2
        assert abs(z.std() - 1) < 0.12


def test_every_draw_is_a_valid_curve():
    study = design(law=THESIS_LAW)
    prior = study.posterior(study.blocks)
    for i in range(30):
        values = study.named(study.draw(np.random.default_rng(i)))
        assert np.isfinite(prior.log_prior(prior.coordinates(values)[None]))


def test_priors_that_allow_no_curve_are_an_error(monkeypatch):
    study = design()
    monkeypatch.setattr("model.study.design.MOST_TRIES", 3)
    monkeypatch.setattr(
        "model.study.design.SlipPosterior.log_prior", lambda _, z: np.full(len(z), -np.inf)
    )
    with pytest.raises(FitError, match="none of 3 draws"):
        study.draw(np.random.default_rng(1))


def test_what_is_known_is_not_fitted():
    study = design()
    known = study.assuming({"radius_error": 0.0})
    assert set(study.free) - set(known.free) == {"radius_error"}


def test_runs_of_one_block_have_neither_offsets_nor_memory():
    study = design(layout(blocks_a_run=1))
    assert {"noise_correlation", "offset_spread"}.isdisjoint(study.free)


def test_a_stated_prior_replaces_the_default_one():
    known = Normal(0.4, 0.05)
    study = design()
    stated = replace(study, priors={**study.priors, "friction": known})
    assert isinstance(stated, StudyDesign)
    assert stated.posterior(stated.blocks).priors["friction"] == known
