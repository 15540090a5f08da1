# SPDX-License-Identifier: MIT
"""Sensor errors, noise, slip wander and bump of a simulated rig."""

from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np

from model.arrays import Array
from model.errors import DomainError

GAIN_SD: Final = 0.005
"""Standard deviation of each force channel's relative gain error [-]."""
BIAS_SD: Final = 0.05
"""Standard deviation of the normal channel's bias [N]."""
CROSSTALK_SD: Final = 0.005
"""Standard deviation of the crosstalk [-]."""


@dataclass(frozen=True)
class RigImperfections:
    """True parameters of a rig besides the slip law; the defaults are an ideal rig.

    Attributes:
        gain_traction: Relative gain error g_t of the traction channel, whose reading is multiplied
            by 1 + g_t [-].
        gain_normal: Relative gain error g_n of the normal channel, whose reading is divided by
            1 + g_n [-].
        bias_normal: Bias b_n of the normal channel, added to the load before the gain [N].
        crosstalk: Normal force c that the normal channel misses for each newton of traction [-].
        offset_sd: Standard deviation tau of the traction channel's zero between runs [N].
        noise_sd0: Traction noise without traction, marginal standard deviation s0 [N].
        noise_sd1: Growth s1 of that standard deviation with the traction [-].
        noise_correlation_time: Correlation time T of the noise, an AR(1) process with
            rho = exp(-dt/T); 0 is white [s].
        load_noise_sd0: White noise of the normal channel without load, standard deviation [N].
        load_noise_sd1: Growth of that standard deviation with the load [-].
        speed_noise: Standard deviation of each disc's white speed-sensor noise [rad/s].
        slip_wander_sd: Standard deviation of the true slip ratio about its set-point, which changes
            speeds and forces alike; none at slip 1, where the ground disc is held still [-].
        slip_wander_time: Correlation time of the slip wander, an Ornstein-Uhlenbeck process; 0 is
            white [s].
        bump_height: Relative rise of the load at the top of the ground disc's bump [-].
        bump_width: Angle of the ground disc under the whole bump [rad].
        radius_error: Relative error of the stated ratio of radii, ground disc over leg disc: the
            true ratio is the stated one times 1 + this [-].
        rolling_resistance: Resistance of rolling over the load, a force against driving at any slip
            while the leg disc turns [-].
        run_out_leg: Run-out of the leg disc: amplitude by which its radius at the contact varies,
            once a turn [m].
        run_out_ground: The same of the ground disc [m].
        run_out_leg_twice: Amplitude by which the leg disc's radius varies twice a turn [m].
        run_out_ground_twice: The same of the ground disc [m].
        delay: Time by which the readings of both forces are behind those of the speeds [s].

    Raises:
        DomainError: A standard deviation, correlation time, height, width or run-out is negative or
            NaN, or an error of a gain or of the radii is not above -1.
    """

    gain_traction: float = 0.0
    gain_normal: float = 0.0
    bias_normal: float = 0.0
    crosstalk: float = 0.0
    offset_sd: float = 0.0
    noise_sd0: float = 0.0
    noise_sd1: float = 0.0
    noise_correlation_time: float = 0.0
    load_noise_sd0: float = 0.0
    load_noise_sd1: float = 0.0
    speed_noise: float = 0.0
    slip_wander_sd: float = 0.0
    slip_wander_time: float = 0.0
    bump_height: float = 0.0
    bump_width: float = 1.0
    radius_error: float = 0.0
    rolling_resistance: float = 0.0
    run_out_leg: float = 0.0
    run_out_ground: float = 0.0
    run_out_leg_twice: float = 0.0
    run_out_ground_twice: float = 0.0
    delay: float = 0.0

    def __post_init__(self) -> None:
        for name in ("gain_traction", "gain_normal", "radius_error"):
            if not getattr(self, name) > -1:
                raise DomainError(f"{name} is {getattr(self, name):g}; expected above -1")
        for name in _NOT_NEGATIVE:
            if not getattr(self, name) >= 0:
                raise DomainError(f"{name} is {getattr(self, name):g}; expected 0 or more")


_SIGNED = {"gain_traction", "gain_normal", "bias_normal", "crosstalk", "radius_error",
           "rolling_resistance", "delay"}  # fmt: skip
_NOT_NEGATIVE = tuple(f.name for f in fields(RigImperfections) if f.name not in _SIGNED)

TYPICAL_RIG = RigImperfections(
    offset_sd=0.05,
    noise_sd0=0.03,
    noise_sd1=0.02,
    noise_correlation_time=0.05,
    speed_noise=0.02,
    slip_wander_sd=0.003,
    slip_wander_time=0.15,
    bump_height=0.6,
)
"""A rig like that of the Thesis with a perfectly calibrated load cell."""


def draw_imperfections(rng: np.random.Generator) -> RigImperfections:
    """Draw gain errors, normal bias and crosstalk from Gaussians around 0; rest as `TYPICAL_RIG`.

    A calibration has priors on these errors. It can only cover the truth at its nominal rate, seed
    after seed, where the truth is drawn from those priors.

    Args:
        rng: Random generator.

    Returns:
        The imperfections of one rig.
    """
    return replace(
        TYPICAL_RIG,
        gain_traction=rng.normal(0.0, GAIN_SD),
        gain_normal=rng.normal(0.0, GAIN_SD),
        bias_normal=rng.normal(0.0, BIAS_SD),
        crosstalk=rng.normal(0.0, CROSSTALK_SD),
    )


def with_load_noise(rig: RigImperfections) -> RigImperfections:
    """Return the rig with the noise of a usual load cell: 0.05 N and 0.5 % of the load."""
    return replace(rig, load_noise_sd0=0.05, load_noise_sd1=0.005)


def measured_load(
    load_true: Array, traction_force: Array, *, imperfections: RigImperfections
) -> Array:
    r"""Compute the reading of the normal channel from the true load.

    .. math::
        F_{n,measured} = \frac{F_n + b_n - c\,F_t}{1 + g_n}

    Args:
        load_true: True normal force F_n, any shape [N].
        traction_force: Measured traction force F_t, same shape [N].
        imperfections: Gain error g_n, bias b_n and crosstalk c.

    Returns:
        Measured normal force, same shape [N].
    """
    seen = load_true + imperfections.bias_normal - imperfections.crosstalk * traction_force
    return seen / (1 + imperfections.gain_normal)


def lag_one_correlation(interval: float, correlation_time: float) -> float:
    """Compute rho = exp(-dt/T), correlation of consecutive samples of an AR(1) process [-].

    Args:
        interval: Time dt between samples [s].
        correlation_time: Correlation time T of the process; 0 gives 0, white noise [s].

    >>> round(lag_one_correlation(0.004, 0.05), 4), lag_one_correlation(0.004, 0.0)
    (0.9231, 0.0)
    """
    return float(np.exp(-interval / correlation_time)) if correlation_time > 0 else 0.0


def bump_rise(angle: Array, *, height: float, width: float) -> Array:
    """Compute the relative rise of the load on the ground disc's bump, a raised cosine.

    Args:
        angle: Ground-disc angle from the top of the bump, any number of turns [rad].
        height: Rise of the load at the top of the bump, per load [-].
        width: Angle of the disc over which the whole bump extends; 0 for no bump [rad].

    Returns:
        Rise of the load, per load off the bump; 0 off the bump, same shape as `angle` [-].

    >>> bump_rise(np.array([0.0, 0.25, 0.5]), height=0.6, width=1.0).round(3).tolist()
    [0.6, 0.3, 0.0]
    """
    from_top = np.abs((angle + np.pi) % (2 * np.pi) - np.pi)
    inside = np.minimum(from_top / (width / 2), 1.0) if width > 0 else np.ones_like(from_top)
    return height / 2 * (1 + np.cos(np.pi * inside))
