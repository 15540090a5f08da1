# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.quantised import QuantisedLog
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.poses import Poses
from model.predict import (
    STEPS,
    LegState,
    ModelSpread,
    anchored,
    bent,
    ensemble_step,
    mean_path,
    predict_paths,
    quantiles,
    scaled_table,
    states_at,
    walk_draws,
    with_contacts,
)
from model.robot import Robot
from model.slip.magic_formula import MagicFormula
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.kernel import table_value
from model.walk.traction import VelocityCoulomb, law_table

T = np.linspace(0.0, 4.0, 41)
T_LOG = np.arange(0.0, 12.2, 0.01)
TABLE = VelocityCoulomb(0.38).table(weight=21.0)
EXACT = ModelSpread(0.0, 0.0, 0.0)
GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)


def straight(m=3) -> Poses:
    x = np.broadcast_to(0.1 * T, (m, len(T)))
    return Poses(T, np.stack([x, 0 * x], axis=-1), np.zeros((m, len(T))))


def counted_log():
    t = np.arange(0.0, 4.2, 0.01)
    theta = GAIT.angles(t)
    step = np.radians(3.6)
    return QuantisedLog(t, step * np.round(theta / step), step)


def predicted(n=12, *, seed=1, offset_sd=0.0175, error=EXACT, legs=None):
    rng = np.random.default_rng(seed)
    state = LegState.of_prior(n, offset_sd=offset_sd, rng=rng)
    draws = walk_draws(Robot(), legs or counted_log(), [TABLE], state, rng=rng)
    return predict_paths(draws, T, state=state, error=error, rng=rng)


def test_a_bent_straight_line_is_a_circle():
    paths = bent(straight(), distance=np.zeros(3), curvature=np.array([0.0, 1.0, -2.0]))
    end = paths.position[:, -1]
    np.testing.assert_allclose(end[0], [0.4, 0], atol=1e-12)
    np.testing.assert_allclose(end[1], [np.sin(0.4), 1 - np.cos(0.4)], atol=1e-5)
    np.testing.assert_allclose(paths.yaw[:, -1], [0, 0.4, -0.8])


@given(stretch=st.floats(-0.1, 0.1))
def test_a_stretched_path_is_longer_by_as_much_and_turns_as_before(stretch):
    paths = bent(straight(), distance=np.full(3, stretch), curvature=np.zeros(3))
    np.testing.assert_allclose(paths.position[:, -1, 0], 0.4 * (1 + stretch))
    np.testing.assert_array_equal(paths.yaw, 0)


def test_an_anchored_path_passes_the_pose_at_its_time():
    rng = np.random.default_rng(1)
    curved = bent(straight(), distance=np.zeros(3), curvature=np.array([0.1, 1.0, -2.0]))
    paths = anchored(curved, np.array([2.0, -1.0, 0.7]), at=1.23, rng=rng)
    here = states_at(paths, np.array([1.23]))[:, 0]
    np.testing.assert_allclose(here, np.broadcast_to([2.0, -1.0, 0.7], (3, 3)), atol=1e-12)
    moved = np.linalg.norm(np.diff(paths.position, axis=1), axis=2)
    np.testing.assert_allclose(moved, np.linalg.norm(np.diff(curved.position, axis=1), axis=2))
    with pytest.raises(DomainError, match="known pose"):
        anchored(curved, np.zeros(3), at=9.0, rng=rng)


def test_an_uncertain_pose_spreads_the_paths_as_much():
    rng = np.random.default_rng(1)
    covariance = np.diag([0.01, 0.02, 0.05]) ** 2
    paths = anchored(straight(4000), np.zeros(3), at=0.0, covariance=covariance, rng=rng)
    np.testing.assert_allclose(
        states_at(paths, T[:1])[:, 0].std(axis=0), [0.01, 0.02, 0.05], rtol=0.05
    )


def test_scaling_a_law_scales_its_traction_and_its_stiffness_apart():
    values = (34.0, 1.56, 0.38, 0.0066)
    law = MagicFormula(curvature=0.0)
    table = law_table(law, values[: len(law.parameters)], weight=21.0)
    for grip, stiffness in ((1.0, 1.0), (0.5, 1.0), (1.0, 1.7), (1.3, 0.6)):
        scaled = scaled_table(table, grip=grip, stiffness=stiffness)
        small, large = 1e-6, 50.0
        assert table_value(scaled, 7.0, small) == pytest.approx(
            stiffness * table_value(table, 7.0, small), rel=1e-3
        )
        assert table_value(scaled, 7.0, large) == pytest.approx(
            grip * table_value(table, 7.0, large), rel=0.02
        )


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
    away = mean_path(paths).position[-1] - true.position[0, -1]
    assert np.linalg.norm(away) < 0.03 * 0.34


def test_quantiles_are_ordered_and_hold_the_share_they_say():
    rng = np.random.default_rng(1)
    paths = anchored(straight(2000), np.zeros(3), at=0.0, covariance=np.eye(3) * 1e-4, rng=rng)
    band = quantiles(paths, (0.05, 0.5, 0.95))
    assert np.all(np.diff(band, axis=0) >= 0)
    inside = (band[0, -1, 1] <= paths.position[:, -1, 1]) & (
        paths.position[:, -1, 1] <= band[2, -1, 1]
    )
    assert inside.mean() == pytest.approx(0.9, abs=0.01)


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


def test_without_its_fall_traction_keeps_its_peak():
    table = law_table(MagicFormula(curvature=0.0), (34.0, 1.56, 0.38), weight=21.0)
    top = table.phi.max()
    kept = scaled_table(table, grip=1.0, stiffness=1.0, fall=0.0)
    half = scaled_table(table, grip=1.0, stiffness=1.0, fall=0.5)
    assert table_value(kept, 7.0, 50.0) == pytest.approx(top, rel=1e-3)
    assert kept.toe[0] == pytest.approx(top)
    lost = [top - table_value(each, 7.0, 50.0) for each in (table, half)]
    assert lost[1] == pytest.approx(lost[0] / 2, rel=1e-3)
    for slip in (1e-6, 1e-3, 0.01):  # before the peak nothing changes
        assert table_value(kept, 7.0, slip) == pytest.approx(table_value(table, 7.0, slip))


def test_friction_that_does_not_fall_has_no_fall():
    scaled = scaled_table(TABLE, grip=1.0, stiffness=1.0, fall=0.0)
    np.testing.assert_allclose(scaled.phi, TABLE.phi)


def test_an_ensemble_takes_the_step_that_its_gait_needs():
    tripod = WalkDraw(Robot(), SampledReference(T_LOG, GAIT.angles(T_LOG)), TABLE)
    four = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    carried = WalkDraw(Robot(), SampledReference(T_LOG, four.angles(T_LOG)), TABLE)
    assert ensemble_step([tripod], duration=12.0).dt == STEPS[0]
    chosen = ensemble_step([carried], duration=12.0)
    assert chosen.dt < STEPS[0]
    fine = planar_walk(carried, duration=12.0, options=DynamicsOptions(dt=0.0005)).poses
    off = []
    for options in (DynamicsOptions(dt=STEPS[0]), chosen):
        path = planar_walk(carried, duration=12.0, options=options).poses
        off.append(np.linalg.norm(path.position[-1] - fine.position[-1]) / fine.length)
    assert off[1] < 0.01 < off[0]
