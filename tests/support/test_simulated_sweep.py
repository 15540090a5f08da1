# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.slip.definition import SlipDefinition
from model.slip.magic_formula import MagicFormula
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import (
    TYPICAL_RIG,
    RigImperfections,
    draw_imperfections,
    lag_one_correlation,
)
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep
from support.true_load import true_load

PERFECT = RigImperfections()
RADII = SweepPlan().radius_leg / SweepPlan().radius_ground


def sweep(imperfections=PERFECT, seed=0, *, plan=None, law=THESIS_LAW, values=THESIS_VALUES):
    rng = np.random.default_rng(seed)
    return simulate_sweep(
        law, values, plan=plan or SweepPlan(), imperfections=imperfections, rng=rng
    )


def by_run(column, plan):
    return np.asarray(column).reshape(plan.n_runs, plan.n_samples)


def lag_one(paths):
    """Correlation from one sample to the next over runs of known zero mean."""
    return np.mean(paths[:, 1:] * paths[:, :-1]) / np.mean(paths**2)


# --- a perfect rig


@pytest.mark.parametrize(
    ("law", "values"),
    [(THESIS_LAW, THESIS_VALUES), (MagicFormula(curvature=0.0), (12.0, 1.3, 0.7))],
)
def test_a_perfect_rig_logs_the_law_itself(law, values):
    log = sweep(law=law, values=values).samples
    expected = law.force(log.slip, log.normal_force, values)
    np.testing.assert_allclose(log.traction_force, expected, rtol=1e-11, atol=1e-12)


def test_a_perfect_rig_logs_the_commanded_slip_and_load():
    plan = SweepPlan()
    load, slip = plan.set_points()
    log = sweep(plan=plan)
    assert log.samples.definition is SlipDefinition.MATERIAL
    np.testing.assert_allclose(by_run(log.samples.slip, plan).T - slip, 0, atol=1e-15)
    np.testing.assert_array_equal(by_run(log.samples.normal_force, plan).T - load, 0)
    np.testing.assert_array_equal(log.table["omega_leg"], plan.omega_leg)


# --- the log


def test_the_same_seed_gives_the_same_bytes_and_another_does_not():
    one, same, other = (sweep(TYPICAL_RIG, seed) for seed in (3, 3, 4))
    for name, column in one.table.items():
        assert column.tobytes() == same.table[name].tobytes()
    assert not np.array_equal(one.table["traction_force"], other.table["traction_force"])


def test_samples_and_table_are_the_same_log():
    log = sweep(TYPICAL_RIG)
    for name in ("normal_force", "traction_force", "run"):
        np.testing.assert_array_equal(getattr(log.samples, name), log.table[name])
    np.testing.assert_array_equal(log.samples.time, log.table["t"])
    expected = 1 - log.table["omega_ground"] / (log.table["omega_leg"] * RADII)
    np.testing.assert_allclose(log.samples.slip, expected, atol=1e-15)


# --- load cell


def test_a_logged_load_leads_back_to_the_true_one():
    rig = draw_imperfections(np.random.default_rng(1))
    log = sweep(rig)
    table = log.table
    back = true_load(table["normal_force"], table["traction_force"], imperfections=rig)
    np.testing.assert_allclose(back, log.load_true, rtol=1e-13)


def test_gain_error_scales_the_traction_and_nothing_else():
    plain, scaled = sweep(), sweep(RigImperfections(gain_traction=0.01))
    expected = 1.01 * plain.table["traction_force"]
    np.testing.assert_allclose(scaled.table["traction_force"], expected, rtol=1e-14)
    np.testing.assert_array_equal(scaled.table["normal_force"], plain.table["normal_force"])


# --- radii and rolling


def test_a_wrong_radius_shifts_measured_slip_by_its_error_times_one_less_slip():
    exact, wrong = sweep(), sweep(RigImperfections(radius_error=0.003))
    np.testing.assert_array_equal(wrong.slip_true, exact.slip_true)
    measured = 1 - (1 - exact.slip_true) / 1.003
    np.testing.assert_allclose(wrong.samples.slip, measured, atol=1e-12)


def test_rolling_resistance_pulls_against_driving_by_its_share_of_the_load():
    free, held = sweep(), sweep(RigImperfections(rolling_resistance=0.03))
    lost = free.table["traction_force"] - held.table["traction_force"]
    np.testing.assert_allclose(lost, 0.03 * free.load_true, rtol=1e-9)


# --- run offsets and noise


def standardised_noise(log, rig, plan):
    """Traction less the law and the offsets, over the promised marginal spread."""
    force = THESIS_LAW.force(log.slip_true, log.load_true, THESIS_VALUES)
    force = (1 + rig.gain_traction) * force
    noise = by_run(log.table["traction_force"] - force, plan) - log.offset_true[:, None]
    return noise / by_run(rig.noise_sd0 + rig.noise_sd1 * np.abs(force), plan)


def test_run_offsets_shift_whole_runs_by_the_promised_spread():
    plan = SweepPlan(slips=tuple(np.linspace(0, 1, 500)), duration=0.02)
    log = sweep(RigImperfections(offset_sd=0.05), plan=plan)
    noise_free = THESIS_LAW.force(log.slip_true, log.load_true, THESIS_VALUES)
    shift = by_run(log.table["traction_force"] - noise_free, plan)
    np.testing.assert_allclose(shift - log.offset_true[:, None], 0, atol=1e-12)
    assert log.offset_true.std() == pytest.approx(0.05, rel=0.1)


@pytest.mark.parametrize(
    ("rate", "duration", "time"), [(250, 1.0, 0.05), (1000, 1.0, -0.001 / np.log(0.98))]
)
def test_noise_is_ar1_of_the_promised_size(rate, duration, time):
    rig = replace(TYPICAL_RIG, gain_traction=0.01, noise_correlation_time=time)
    plan = SweepPlan(rate=rate, duration=duration)
    noise = standardised_noise(sweep(rig, plan=plan), rig, plan)
    assert noise.std() == pytest.approx(1.0, rel=0.05)
    assert lag_one(noise) == pytest.approx(lag_one_correlation(1 / rate, time), abs=0.005)


def test_noise_is_stationary_from_the_first_sample_and_new_in_each_run():
    plan = SweepPlan(slips=tuple(np.linspace(0, 1, 1000)), duration=0.02)
    noise = standardised_noise(sweep(TYPICAL_RIG, plan=plan), TYPICAL_RIG, plan)
    np.testing.assert_allclose(noise.std(axis=0), 1.0, rtol=0.07)
    across = np.mean(noise[1:, 0] * noise[:-1, -1])
    assert abs(across) < 4 / np.sqrt(plan.n_runs)


# --- the bump


def test_the_bump_lifts_the_load_by_its_height_once_a_turn():
    turns = 5
    duration = turns * 2 * np.pi / (12 * RADII)  # of the ground disc, without slip
    plan = SweepPlan(slips=(0.0,), loads=(6.63,), duration=duration, rate=2000)
    load = sweep(RigImperfections(bump_height=0.6), plan=plan).load_true / 6.63
    assert load.max() == pytest.approx(1.6, abs=1e-4)
    assert load.min() == 1.0
    climbs = np.sum((load[1:] > 1.3) & (load[:-1] <= 1.3))
    assert climbs == turns
    assert np.mean(load > 1) == pytest.approx(1 / (2 * np.pi), abs=0.01)


def test_the_ground_disc_turns_on_from_run_to_run():
    cut = SweepPlan(slips=(0.0,) * 6, loads=(5.0,), duration=0.5)
    whole = SweepPlan(slips=(0.0,), loads=(5.0,), duration=3.0)
    bumpy = RigImperfections(bump_height=0.6)
    start = sweep(bumpy, plan=whole).load_true
    # the wander's draws come before the starting angle, and both plans draw as many
    np.testing.assert_allclose(sweep(bumpy, plan=cut).load_true, start, rtol=1e-12)


# --- slip: true wander and sensor noise are different things


def test_true_slip_wanders_by_the_promised_spread_and_time():
    plan = SweepPlan(duration=4.0)
    log = sweep(TYPICAL_RIG, plan=plan)
    slip = plan.set_points()[1]
    wander = (by_run(log.slip_true, plan) - slip[:, None])[slip < 1]
    assert wander.std() == pytest.approx(0.003, rel=0.05)
    for lag in (1, 15, 75):  # from a fraction of the correlation time to twice it
        found = np.mean(wander[:, lag:] * wander[:, :-lag]) / np.mean(wander**2)
        assert found == pytest.approx(np.exp(-lag * 0.004 / 0.15), abs=0.05)


def test_sensor_noise_blurs_measured_slip_but_not_the_force():
    plan = SweepPlan()
    log = sweep(RigImperfections(speed_noise=0.02), plan=plan)
    expected = THESIS_LAW.force(log.slip_true, log.load_true, THESIS_VALUES)
    np.testing.assert_allclose(log.samples.traction_force, expected, rtol=1e-11)
    error = by_run(log.samples.slip - log.slip_true, plan)
    slip = plan.set_points()[1]
    promised = 0.02 / 12 * np.hypot(1 / RADII, 1 - slip)  # first order in both speeds' noise
    assert (error / promised[:, None]).std() == pytest.approx(1.0, rel=0.02)
    assert abs(lag_one(error)) < 4 / np.sqrt(error.size)


def test_recorded_angles_turn_as_the_discs_do_and_leave_the_rest_as_it_is():
    plan = SweepPlan(slips=(0.0, 0.5), loads=(6.0,))
    plain = sweep(plan=plan)
    log = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=PERFECT,
        rng=np.random.default_rng(0), angles=True,
    )  # fmt: skip
    assert "angle_leg" not in plain.table
    assert plain.samples.angles is None
    for disc in ("leg", "ground"):
        turned = np.diff(log.table[f"angle_{disc}"]) * plan.rate
        np.testing.assert_allclose(turned, log.table[f"omega_{disc}"][1:], rtol=1e-9)
    np.testing.assert_array_equal(log.table["normal_force"], plain.table["normal_force"])


def test_radii_at_the_contact_swing_once_and_twice_a_turn_and_speeds_do_not():
    plan = SweepPlan(slips=(0.1,), loads=(6.0,), duration=4.0)
    rig = RigImperfections(run_out_leg=1e-4, run_out_leg_twice=5e-5)
    log = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=rig,
        rng=np.random.default_rng(0), angles=True,
    )  # fmt: skip
    np.testing.assert_allclose(log.samples.slip, 0.1)
    angle = log.table["angle_leg"]
    rise = (1e-4 * np.cos(angle) + 5e-5 * np.cos(2 * angle)) / plan.radius_leg
    np.testing.assert_allclose(log.slip_true, 1 - 0.9 / (1 + rise))
