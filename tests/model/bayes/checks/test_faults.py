# SPDX-License-Identifier: MIT
"""A fault of samples or runs fails its check, with a cause and an advice."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.check import Outcome
from model.bayes.checks.faults import faults
from support.linearised_fits import CHOICE, linearised, unchanged, with_force


def checks_on(change=unchanged, correlation=5.0):
    posterior, fit, samples = linearised(change)
    made = faults(
        posterior,
        fit,
        samples,
        explained=np.zeros(len(fit.blocks)),
        choice=replace(CHOICE, correlation=correlation),
    )
    return {check.name: check for check in made}


PLANTED = {
    "traction has the sign of the slip": (
        lambda s: replace(s, traction_force=s.traction_force * np.where(s.run % 9 == 3, -1, 1)),
        "opposes the slip in 5 runs",
    ),
    "no samples leap from their neighbours": (
        with_force(lambda s: 4.0 * (np.arange(len(s)) % 97 == 50)), "outliers: ",
    ),
    "no force stops at a limit": (
        lambda s: replace(s, traction_force=np.clip(s.traction_force, -3, 3)),
        "traction is clipped: ",
    ),
    "runs have one friction": (
        lambda s: replace(s, traction_force=s.traction_force * np.where(s.run % 3, 1, 0.8)),
        "two materials",
    ),
}  # fmt: skip


def test_a_sound_rig_passes_every_check():
    made = checks_on()
    assert {check.outcome for check in made.values()} == {Outcome.PASSED}
    assert {*PLANTED, "traction follows slip at once", "values lie within their priors"} < {*made}


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_fault_fails_its_check_and_names_its_cause(name):
    change, cause = PLANTED[name]
    check = checks_on(change)[name]
    assert check.failed
    assert cause in check.cause
    assert check.advice is not None
    assert check.advice.reason == check.cause


def test_runs_shorter_than_the_memory_of_the_noise_test_no_noise():
    name = "runs outlast the memory of the noise"
    assert checks_on(correlation=10.0)[name].passed
    assert checks_on(correlation=25.0)[name].untested == "noise in time (too short)"
    assert name not in checks_on(correlation=None)


def test_values_far_from_their_priors_are_implausible():
    posterior, fit, samples = linearised()
    far = replace(fit, z=fit.z + 6.0 * np.eye(len(fit.z))[2])
    made = faults(
        posterior, far, samples, explained=np.zeros(len(fit.blocks)), choice=CHOICE
    )  # fmt: skip
    (check,) = [each for each in made if each.name == "values lie within their priors"]
    assert check.failed
    assert "friction" in check.cause
    assert "unit of a force" in check.cause
