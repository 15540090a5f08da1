# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.bayes.posterior import LoadCell
from model.bayes.run_out import find_run_out, without_run_out
from model.slip.rig_errors import RUN_OUT
from model.slip.thesis_curve import THESIS_LAW
from support.out_of_true import ERRORS, swept

TRUE = RUN_OUT * np.array([1.0, 0, 1, 0, 1, 0, 1, 0])


def found_in(samples, errors=ERRORS):
    return find_run_out(
        samples, THESIS_LAW, load_cell=LoadCell(), rig_errors=errors, rng=np.random.default_rng(0)
    )


@pytest.fixture(scope="module")
def sweep():
    return swept()


@pytest.fixture(scope="module")
def found(sweep):
    return found_in(sweep.samples)


def test_coefficients_of_both_harmonics_and_discs_are_found_within_their_errors(found):
    sd = np.concatenate([disc.sd for disc in found.discs])
    assert [disc.disc for disc in found.discs] == ["leg", "ground"]
    assert np.all(np.abs(found.coefficients - TRUE) < 3.5 * sd)
    assert np.mean(((found.coefficients - TRUE) / sd) ** 2) < 2.5
    assert np.all(sd[:4] < 0.2 * RUN_OUT)


def test_slip_is_corrected_where_left_out_runs_are_predicted_better(sweep, found):
    assert found.used
    before = sweep.samples.slip - sweep.slip_true
    after = without_run_out(sweep.samples, found).slip - sweep.slip_true
    noise = np.std(np.diff(before)) / np.sqrt(2)
    assert np.var(after) - noise**2 < 0.1 * (np.var(before) - noise**2)


def test_the_scatter_that_is_left_is_what_is_not_known(found):
    assert 0.1 * ERRORS.slip_scatter < found.scatter < 0.7 * ERRORS.slip_scatter


def test_wrapped_angles_from_another_zero_give_the_same_slip(sweep, found):
    angles = sweep.samples.angles
    turned = replace(
        angles, leg=(-angles.leg - 1.0) % (2 * np.pi), ground=angles.ground + 2 * np.pi * 7 + 0.5
    )
    other = replace(sweep.samples, angles=turned)
    again = without_run_out(other, found_in(other))
    first = without_run_out(sweep.samples, found)
    np.testing.assert_allclose(again.slip, first.slip, atol=2e-5)


def test_of_one_disc_alone_its_own_run_out_is_found(sweep):
    samples = sweep.samples
    alone = found_in(replace(samples, angles=replace(samples.angles, ground=None)))
    (leg,) = alone.discs
    assert (leg.disc, alone.used) == ("leg", True)
    assert np.all(np.abs(leg.coefficients - TRUE[:4]) < 4 * leg.sd)
    assert alone.scatter > RUN_OUT / 0.12 / np.sqrt(2)  # of the other disc


@pytest.mark.long
def test_discs_that_run_true_are_left_alone():
    found = found_in(swept(0.0, 0.0, seed=1).samples)
    assert not found.used
    sd = np.concatenate([disc.sd for disc in found.discs])
    assert np.all(np.abs(found.coefficients) < 3.5 * sd)


def test_angles_whose_zero_changes_from_run_to_run_are_not_used(sweep):
    samples = sweep.samples
    zero = np.random.default_rng(3).uniform(0, 2 * np.pi, (2, samples.n_runs))[:, samples.run]
    angles = replace(
        samples.angles, leg=samples.angles.leg + zero[0], ground=samples.angles.ground + zero[1]
    )
    assert not found_in(replace(samples, angles=angles)).used


@pytest.mark.long
def test_a_dial_gauge_that_says_the_discs_run_true_is_believed(sweep, found):
    stated = found_in(sweep.samples, replace(ERRORS, run_out=1e-6))
    assert np.all(np.abs(stated.coefficients) < 0.3 * np.abs(found.coefficients).max())


def test_without_angles_there_is_nothing_to_find(sweep):
    assert found_in(replace(sweep.samples, angles=None)) is None
    assert found_in(sweep.samples, replace(ERRORS, run_out=0.0)) is None


def test_runs_of_a_few_samples_say_nothing():
    samples = swept().samples
    few = np.concatenate([np.arange(part.start, part.start + 12) for part in samples.slices()])
    short = replace(
        samples, slip=samples.slip[few], normal_force=samples.normal_force[few],
        traction_force=samples.traction_force[few], run=samples.run[few], time=None,
        angles=replace(
            samples.angles, leg=samples.angles.leg[few], ground=samples.angles.ground[few]
        ),
    )  # fmt: skip
    assert found_in(short) is None
