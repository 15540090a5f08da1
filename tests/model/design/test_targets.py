# SPDX-License-Identifier: MIT
"""Targets are linear around each draw, and forces are relative to their size."""

import numpy as np
import pytest

from model.design.targets import (
    Target,
    force_rows,
    force_target,
    parameter_target,
    regressed_target,
)
from model.errors import InsufficientData
from support.small_layouts import posterior as posterior_of


@pytest.fixture(scope="module")
def posterior():
    return posterior_of()


@pytest.fixture(scope="module")
def draws(posterior):
    return 0.2 * np.random.default_rng(3).standard_normal((4, len(posterior.free)))


def test_a_parameter_depends_on_its_own_coordinate_alone(posterior, draws):
    target = parameter_target(posterior, draws, "friction")
    own = [p.name for p in posterior.free].index("friction")
    value = posterior.values(draws)[:, [p.name for p in posterior.parameters].index("friction")]
    assert target.rows[:, 0, own] == pytest.approx(0.7 * value, rel=1e-5)  # of a log-normal
    assert np.abs(np.delete(target.rows, own, axis=2)).max() == 0
    assert (target.parts, target.units) == (("friction",), ("dimensionless",))


def test_relative_forces_of_a_law_in_proportion_to_load_do_not_depend_on_it(posterior, draws):
    slips, loads = np.array([0.02, 0.4]), np.array([2.0, 9.0])
    target = force_target(posterior, draws, name="x", slips=slips, loads=loads)
    assert target.parts == ("force@0.02:2", "force@0.4:2", "force@0.02:9", "force@0.4:9")
    assert target.rows[:, :2] == pytest.approx(target.rows[:, 2:], rel=1e-6, abs=1e-9)
    force, rows = force_rows(posterior, draws, slip=slips, load=np.full(2, 9.0))
    assert rows == pytest.approx(target.rows[:, 2:] * force[..., None])


def test_a_force_of_nothing_is_refused(posterior, draws):
    with pytest.raises(InsufficientData, match="at slip 1e-09 and load 5 N is nearly zero"):
        force_target(posterior, draws, name="x", slips=np.array([1e-9]), loads=np.array([5.0]))


def test_sds_are_geometric_means_over_draws():
    target = Target("x", ("x",), ("m",), np.array([[[2.0, 0.0]], [[0.0, 1.0]]]))
    covariance = np.stack([np.eye(2), np.diag([1.0, 4.0])])
    assert target.log_sd(covariance) == pytest.approx(np.log([[2.0], [2.0]]))
    assert target.sds(0.25 * covariance) == pytest.approx([1.0])


def test_a_regression_finds_the_slopes_and_leaves_out_what_does_not_differ():
    rng = np.random.default_rng(0)
    drawn = rng.standard_normal((40, 4)) * [1.0, 0.01, 0.0, 2.0]
    slopes = np.array([[1.0, -2.0], [30.0, 0.0], [9.0, 9.0], [0.5, 1.0]])
    target = regressed_target(
        "walk", drawn, drawn @ slopes, parts=("a", "b"), units=("m", "rad"), n_draws=3
    )  # fmt: skip
    expected = slopes.T.copy()
    expected[:, 2] = 0.0
    assert target.rows == pytest.approx(np.broadcast_to(expected, (3, 2, 4)))


def test_too_few_draws_or_none_that_differ_are_refused():
    given = {"parts": ("a",), "units": ("m",), "n_draws": 1}
    drawn = np.random.default_rng(0).standard_normal((3, 3))
    with pytest.raises(InsufficientData, match="3 computed draws of walk tell no slope"):
        regressed_target("walk", drawn, drawn[:, :1], **given)
    with pytest.raises(InsufficientData, match="tell no slope"):
        regressed_target("walk", np.vstack([drawn, -drawn]), np.zeros((6, 1)), **given)
