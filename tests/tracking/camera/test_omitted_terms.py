# SPDX-License-Identifier: MIT
"""What is claimed of a lens without some terms holds on average over lenses that may have them."""

from itertools import product

import numpy as np
import pytest

from tracking.camera.omitted_terms import PRIOR_SD, with_omitted_terms

K1_ONLY = (0, 1, 2, 3, 4)
EVERY = tuple(range(9))


def covariance(rng: np.random.Generator) -> np.ndarray:
    """Draw a covariance in which cx and p2, and cy and p1, make up for each other."""
    sd = np.array([1.0, 1.0, 2.0, 2.0, 3e-3, 2e-2, 3e-4, 3e-4, 5e-2])
    mixed = np.eye(9)
    mixed[2, 7] = mixed[3, 6] = mixed[0, 4] = mixed[1, 5] = 3.0
    mixed += 0.2 * rng.normal(size=(9, 9))
    correlation = mixed @ mixed.T
    unit = np.sqrt(np.diag(correlation))
    return correlation / np.outer(unit, unit) * np.outer(sd, sd)


def without(terms, found, C):
    """Return estimate and covariance where `terms` are known to be zero."""
    gain = np.linalg.solve(C[np.ix_(terms, terms)], C[terms]).T
    return found - gain @ found[terms], C - gain @ C[terms]


def test_errors_and_probabilities_hold_over_lenses_with_and_without_the_terms():
    rng = np.random.default_rng(1)
    C = covariance(rng)
    root, left_out = np.linalg.cholesky(C), [5, 6, 7, 8]
    models = [(*radial, *tangential)
              for radial, tangential in product(((), (5,), (5, 8)), ((), (6, 7)))]  # fmt: skip
    errors, claimed, none, probable = [], [], [], []
    for _ in range(4000):
        terms = list(models[rng.integers(len(models))])
        lens = np.zeros(9)
        lens[terms] = [PRIOR_SD[term] * rng.normal() for term in terms]
        general = lens + root @ rng.normal(size=9)
        fitted, conditional = without(left_out, general, C)
        averaged, probability = with_omitted_terms(fitted, conditional, K1_ONLY, general, C)
        errors.append((fitted - lens)[:4])
        claimed.append(np.diag(averaged)[:4])
        none.append(not terms)
        probable.append(probability)
    ratio = np.mean(np.square(errors), axis=0) / np.mean(claimed, axis=0)
    assert ratio == pytest.approx(1.0, abs=0.1)
    sure = np.array(probable) > np.median(probable)
    for some in (sure, ~sure):
        assert np.mean(np.array(probable)[some]) == pytest.approx(
            np.mean(np.array(none)[some]), abs=0.03
        )


def test_terms_that_are_known_to_vanish_leave_the_covariance():
    C = covariance(np.random.default_rng(2)) * 1e-6
    fitted, conditional = without([5, 6, 7, 8], np.zeros(9), C)
    averaged, probability = with_omitted_terms(fitted, conditional, K1_ONLY, np.zeros(9), C)
    assert probability > 0.999
    assert np.diag(averaged)[:5] == pytest.approx(np.diag(conditional)[:5], rel=1e-2)


def test_terms_that_are_far_from_zero_make_a_lens_without_them_improbable():
    C = covariance(np.random.default_rng(3))
    general = np.zeros(9)
    general[7] = 10 * np.sqrt(C[7, 7])
    fitted, conditional = without([5, 6, 7, 8], general, C)
    averaged, probability = with_omitted_terms(fitted, conditional, K1_ONLY, general, C)
    assert probability < 1e-6
    assert averaged[2, 2] > (general - fitted)[2] ** 2 * 0.8


def test_a_lens_with_all_terms_keeps_its_covariance():
    C = covariance(np.random.default_rng(4))
    averaged, probability = with_omitted_terms(np.ones(9), C, EVERY, np.ones(9), C)
    assert (averaged, probability) == (pytest.approx(C), 1.0)
