# SPDX-License-Identifier: MIT

import numpy as np
import pytest

from model.errors import DomainError
from model.gait.inexact_log import InexactLog
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.leg_state import LegState
from model.predict import (
    STEPS,
    ModelSpread,
    ensemble_step,
    predict_paths,
    walk_draws,
    with_contacts,
)
from model.robot import Robot
from model.slip import MagicFormula
from model.travel import path_length
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.traction import VelocityCoulomb, law_table

T = np.linspace(0.0, 4.0, 41)
T_LOG = np.arange(0.0, 12.2, 0.01)
TABLE = VelocityCoulomb(0.38).table(weight=21.0)
EXACT = ModelSpread(0.0, 0.0, 0.0)
GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)


def counted_log():
    t = np.arange(0.0, 4.2, 0.01)
    theta = GAIT.angles(t)
    step = np.radians(3.6)
    return InexactLog(t, step * np.round(theta / step), step)


def predicted(n=12, *, seed=1, offset_sd=0.0175, error=EXACT, legs=None):
    rng = np.random.default_rng(seed)
    state = LegState.of_prior(n, offset_sd=offset_sd, rng=rng)
    draws = walk_draws(Robot(), legs or counted_log(), [TABLE], state, rng=rng)
    return predict_paths(draws, T, state=state, error=error, rng=rng)


def test_the_same_seed_gives_the_same_paths():
    np.testing.assert_array_equal(predicted().position, predicted().position)


def test_paths_spread_more_the_less_is_known_of_the_legs():
    spread = [predicted(24, offset_sd=np.radians(sd)).yaw[:, -1].std() for sd in (0.0, 0.5, 2.0)]
    assert spread[0] < spread[1] < spread[2]


def test_without_unknowns_every_draw_walks_the_same_way():
    paths = predicted(3, offset_sd=0.0, legs=GAIT)
    np.testing.assert_array_equal(paths.position[0], paths.position[1])


def test_counted_angles_lead_where_the_angles_do():
    paths = predicted(16, offset_sd=0.0)
    true = predicted(1, offset_sd=0.0, legs=GAIT)
    away = paths.position[:, -1].mean(axis=0) - true.position[0, -1]
    assert np.linalg.norm(away) < 0.03 * 0.34


def test_a_negative_spread_is_refused():
    with pytest.raises(DomainError):
        ModelSpread(distance=-0.1)


def test_how_hard_contacts_are_decides_where_four_legs_lead_but_hardly_where_a_tripod_does():
    four = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    spread = []
    for gait in (four, GAIT):
        log = SampledReference(T_LOG, gait.angles(T_LOG))
        error = ModelSpread(0.0, 0.0, contacts=np.log(2.0))
        paths = predicted(8, offset_sd=0.0, error=error, legs=log)
        length = np.linalg.norm(np.diff(paths.position, axis=1), axis=2).sum(axis=1).mean()
        spread.append(paths.yaw[:, -1].std() / length)
    assert spread[0] > 3 * spread[1] > 0


def test_contacts_of_no_spread_are_left_as_they_are():
    draw = WalkDraw(Robot(), SampledReference(T_LOG, GAIT.angles(T_LOG)), TABLE)
    assert with_contacts([draw], EXACT, rng=np.random.default_rng(1)) == [draw]
    (drawn,) = with_contacts([draw], ModelSpread(), rng=np.random.default_rng(1))
    options = drawn.options(DynamicsOptions(stiffness=1e5, damping=100.0))
    assert options.stiffness == pytest.approx(1e5 * drawn.stiffness)
    assert options.damping == pytest.approx(100.0 * drawn.damping)
    assert drawn.stiffness != 1.0 != drawn.damping


def test_an_ensemble_takes_the_step_that_its_gait_needs():
    tripod, four, hopping = (
        WalkDraw(Robot(), SampledReference(T_LOG, gait.angles(T_LOG)), TABLE)
        for gait in (
            GAIT,
            tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0),
            tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=0.6),
        )
    )
    assert ensemble_step([tripod], duration=12.0).dt == STEPS[0]
    assert ensemble_step([four], duration=12.0).dt == STEPS[0]
    assert error_of_step(four, DynamicsOptions(dt=STEPS[0])) < 0.01
    chosen = ensemble_step([hopping], duration=12.0)
    assert chosen.dt < STEPS[0]
    longest = error_of_step(hopping, DynamicsOptions(dt=STEPS[0]))
    assert error_of_step(hopping, chosen) < 0.5 * longest


def error_of_step(draw, options):
    """Return how far a walk of 12 s ends from that of 0.5 ms steps, over the length of its path."""
    fine = planar_walk(draw, duration=12.0, options=DynamicsOptions(dt=0.0005)).poses
    path = planar_walk(draw, duration=12.0, options=options).poses
    return np.linalg.norm(path.position[-1] - fine.position[-1]) / path_length(fine)


def test_lateral_traction_widens_the_band_of_a_turn_and_hardly_that_of_a_straight_walk():
    t, widths = np.linspace(0.0, 6.0, 7), {}
    curve = law_table(MagicFormula(curvature=0.0), (20.4, 1.564, 0.38), weight=21.0)
    for name, steering in (("straight", 1.0), ("turn", 1.3)):
        gait = tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0)
        log = SampledReference(T_LOG, gait.angles(T_LOG))
        for factor in (1.0, 1.3):
            rng = np.random.default_rng(1)
            state = LegState.of_prior(40, offset_sd=0.0, anisotropy=factor, rng=rng)
            draws = walk_draws(Robot(), log, [curve], state, rng=rng)
            paths = predict_paths(
                draws, t, state=state, error=EXACT, rng=rng, options=DynamicsOptions(dt=0.005)
            )
            widths[name, factor] = paths.states[:, -1].std(axis=0)
    np.testing.assert_allclose(widths["turn", 1.0], 0.0, atol=1e-9)
    assert widths["turn", 1.3][2] > 3 * widths["straight", 1.3][2]
    assert widths["turn", 1.3][2] > np.radians(0.02)
