# SPDX-License-Identifier: MIT
"""Simulate the log of a sweep of the two-disc rig with a known slip law.

The force model is the one that a calibration assumes, so the truth lies inside the fitted family:
coverage and recovery can be judged against it. Not modelled: quantisation, dropped samples,
saturation, temperature drift within a run, wear, play, and the transients between set-points.
"""

from dataclasses import dataclass, replace
from itertools import accumulate
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.slip.definition import SlipDefinition, slip_ratio
from model.slip.law import SlipLaw, Values
from model.slip.rig_errors import RigErrors
from model.slip.samples import DiscAngles, SlipSamples
from rig.slip_rig.imperfections import (
    RigImperfections,
    bump_rise,
    draw_imperfections,
    lag_one_correlation,
    measured_load,
)
from rig.slip_rig.sweep import SweepPlan

Column: TypeAlias = Array | NDArray[np.int64]


def draw_rig(rng: np.random.Generator, errors: RigErrors) -> RigImperfections:
    """Draw errors of load cell, radii and rolling: Gaussians of the scales of the priors."""
    return replace(
        draw_imperfections(rng),
        radius_error=rng.normal(0.0, errors.radius_ratio),
        rolling_resistance=rng.normal(0.0, errors.rolling_resistance),
    )


@dataclass(frozen=True)
class SimulatedSweep:
    """Log of a simulated sweep, with the true values.

    Attributes:
        samples: The log as input of a calibration: slip from both measured disc speeds.
        table: The log as a recorder would write it, canonical columns `t` (runs on through the
            whole sweep) [s], `omega_leg`, `omega_ground` [rad/s], `normal_force`,
            `traction_force` [N] and `run` (index of the set-point), each of shape (n,); where
            asked for also `angle_leg` and `angle_ground` [rad].
        slip_true: True slip ratio, shape (n,) [-].
        load_true: True normal force, shape (n,) [N].
        offset_true: True traction zero b_run of every run, shape (runs,) [N].
    """

    samples: SlipSamples
    table: dict[str, Column]
    slip_true: Array
    load_true: Array
    offset_true: Array


def simulate_sweep(
    law: SlipLaw,
    values: Values,
    *,
    plan: SweepPlan,
    imperfections: RigImperfections,
    rng: np.random.Generator,
    angles: bool = False,
) -> SimulatedSweep:
    r"""Simulate the log of a sweep.

    .. math::
        F_t = (1 + g_t)\,[f(\kappa, F_n) - c_r F_n] + b_{run} + e, \qquad
        F_n = (1 + g_n)\,(F_{n,measured} - w) - b_n + c\,F_t

    with white noise w, whose standard deviation grows with the load, F_t the measured traction, f
    the law at the true slip kappa and load F_n of `delay` before,
    b_run ~
    N(0, tau²), and e an AR(1) process, stationary and independent in each run, whose marginal
    standard deviation is s0 + s1 times the size of the first term; g_t, g_n, b_n, c, c_r, tau, s0
    and s1 as in `RigImperfections`.

    Args:
        law: The true slip law, in the material slip ratio.
        values: Values of the law's parameters, numbers.
        plan: Set-points.
        imperfections: Sensor errors, noise and bump of the rig.
        rng: Random generator: the same state gives the same sweep.
        angles: Whether the log has the angles of both discs, without error, from where the largest
            radius of the first harmonic is at the contact.

    Returns:
        The log and the true values.
    """
    slip = _wander_slip(plan, imperfections, rng)
    true_radius = plan.radius_ground * (1 + imperfections.radius_error)
    omega_ground = plan.speed_leg * (1 - slip) / true_radius
    load = _ride_bump(omega_ground, plan, imperfections, rng)
    turned = None
    if angles or any(_amplitudes(imperfections)):
        turned = _disc_angles(omega_ground, plan, rng)
        slip = _run_out(slip, turned, plan, imperfections)
    offset = rng.normal(0.0, imperfections.offset_sd, plan.n_runs)
    pulled = law.force(slip, load, values) - imperfections.rolling_resistance * load
    force = _late((1 + imperfections.gain_traction) * pulled, plan, imperfections)
    traction_force = force + offset[:, None] + _force_noise(force, plan, imperfections, rng)
    pressed = _late(load, plan, imperfections)
    normal_force = measured_load(pressed, traction_force, imperfections=imperfections)
    size = imperfections.load_noise_sd0 + imperfections.load_noise_sd1 * pressed
    if size.any():  # else the same state of the generator gives the speeds that it always gave
        normal_force = normal_force + size * rng.standard_normal(size.shape)
    table: dict[str, Column] = {
        "t": np.arange(slip.size) / plan.rate,
        "omega_leg": plan.omega_leg + rng.normal(0.0, imperfections.speed_noise, slip.size),
        "omega_ground": omega_ground.ravel()
        + rng.normal(0.0, imperfections.speed_noise, slip.size),
        "normal_force": normal_force.ravel(),
        "traction_force": traction_force.ravel(),
        "run": np.repeat(np.arange(plan.n_runs), plan.n_samples),
    }
    if angles and turned is not None:
        table |= {"angle_leg": turned[0].ravel(), "angle_ground": turned[1].ravel()}
    samples = samples_from_table(table, plan)
    return SimulatedSweep(samples, table, slip.ravel(), load.ravel(), offset)


def samples_from_table(table: dict[str, Column], plan: SweepPlan) -> SlipSamples:
    """Convert a sweep's log to samples, with slip from both measured disc speeds, Eq. (4-44).

    Args:
        table: Canonical columns, as in `SimulatedSweep.table`.
        plan: Set-points of the sweep, with the radii and the names of the runs.

    Returns:
        The samples, in the material slip ratio.
    """
    slip = slip_ratio(
        table["omega_leg"] * plan.radius_leg,
        table["omega_ground"] * plan.radius_ground,
        SlipDefinition.MATERIAL,
    )
    return SlipSamples(
        slip=slip,
        normal_force=np.asarray(table["normal_force"], dtype=float),
        traction_force=np.asarray(table["traction_force"], dtype=float),
        run=np.asarray(table["run"], dtype=np.intp),
        run_names=plan.run_names(),
        definition=SlipDefinition.MATERIAL,
        time=np.asarray(table["t"], dtype=float),
        angles=DiscAngles(
            np.asarray(table["angle_leg"], dtype=float),
            np.asarray(table["angle_ground"], dtype=float),
            plan.radius_leg,
            plan.radius_ground,
        )
        if "angle_leg" in table
        else None,
    )


def _wander_slip(plan: SweepPlan, truth: RigImperfections, rng: np.random.Generator) -> Array:
    """Simulate the true slip ratio: set-point plus AR(1) wander, shape (runs, samples) [-].

    At set-point 1 it does not wander.
    """
    _, slip = plan.set_points()
    rho = lag_one_correlation(1 / plan.rate, truth.slip_wander_time)
    wander = truth.slip_wander_sd * _stationary_ar1(rho, plan, rng)
    turning = slip < 1  # a drive commanded to stand holds its shaft
    return slip[:, None] + wander * turning[:, None]


def _ride_bump(
    omega_ground: Array, plan: SweepPlan, truth: RigImperfections, rng: np.random.Generator
) -> Array:
    """Simulate the true load on the ground disc's bump, shape (runs, samples) [N].

    The disc starts at a random angle and turns on from run to run, with speed `omega_ground` of
    shape (runs, samples) [rad/s].
    """
    load, _ = plan.set_points()
    turned = np.cumsum(omega_ground.ravel()).reshape(omega_ground.shape) / plan.rate
    angle = rng.uniform(0.0, 2 * np.pi) + turned
    return load[:, None] * (1 + bump_rise(angle, height=truth.bump_height, width=truth.bump_width))


def _amplitudes(truth: RigImperfections) -> tuple[float, float, float, float]:
    """Return the amplitudes of run-out, once and twice a turn: leg disc, then ground disc [m]."""
    return (
        truth.run_out_leg, truth.run_out_leg_twice,
        truth.run_out_ground, truth.run_out_ground_twice,
    )  # fmt: skip


def _disc_angles(
    omega_ground: Array, plan: SweepPlan, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Compute the angles of leg disc and ground disc, (runs, samples) each [rad].

    They start anywhere and go on from run to run. The ground disc's speed is `omega_ground`
    [rad/s], the leg disc's is the plan's.
    """
    starts, shape = rng.uniform(0.0, 2 * np.pi, 2), omega_ground.shape
    leg = starts[0] + plan.omega_leg * np.arange(omega_ground.size).reshape(shape) / plan.rate
    return leg, starts[1] + np.cumsum(omega_ground.ravel()).reshape(shape) / plan.rate


def _run_out(
    slip: Array, angles: tuple[Array, Array], plan: SweepPlan, truth: RigImperfections
) -> Array:
    """Compute the true slip of discs out of true, whose speeds give `slip`; (runs, samples) [-].

    The drives hold the *speeds*, whatever the radii: run-out is in the true slip and the force, and
    not in the slip that speeds and nominal radii give. The radius at the contact is
    r + a cos(angle) + b cos(2 angle), with the amplitudes a and b.
    """
    leg_once, leg_twice, ground_once, ground_twice = _amplitudes(truth)
    leg, ground = angles
    rise_leg = leg_once * np.cos(leg) + leg_twice * np.cos(2 * leg)
    rise_ground = ground_once * np.cos(ground) + ground_twice * np.cos(2 * ground)
    ratio = (1 + rise_ground / plan.radius_ground) / (1 + rise_leg / plan.radius_leg)
    return 1 - (1 - slip) * ratio


def _late(values: Array, plan: SweepPlan, truth: RigImperfections) -> Array:
    """Delay forces within each run, shape (runs, samples) [N]; the first one is held."""
    if not truth.delay:
        return values
    t = np.arange(plan.n_samples) / plan.rate
    return np.stack([np.interp(t - truth.delay, t, run) for run in values])


def _force_noise(
    force: Array, plan: SweepPlan, truth: RigImperfections, rng: np.random.Generator
) -> Array:
    """Simulate the traction channel's AR(1) noise at a force, both of shape (runs, samples) [N]."""
    rho = lag_one_correlation(1 / plan.rate, truth.noise_correlation_time)
    size = truth.noise_sd0 + truth.noise_sd1 * np.abs(force)
    return size * _stationary_ar1(rho, plan, rng)


def _stationary_ar1(rho: float, plan: SweepPlan, rng: np.random.Generator) -> Array:
    """Draw a stationary AR(1) path of unit variance for each run, shape (runs, samples) [-]."""
    shock = rng.standard_normal((plan.n_runs, plan.n_samples))
    shock[:, 1:] *= np.sqrt(1 - rho**2)  # the first sample already has the marginal variance
    steps = accumulate(shock.T, lambda before, step: rho * before + step)
    return np.stack(list(steps), axis=1)
