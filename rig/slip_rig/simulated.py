# SPDX-License-Identifier: MIT
"""Simulated two-disc rig: discs, contact and load cell over time, without a protocol.

Its force comes from any slip law of `model`, so that a calibration can be tried on one that is not
the fitted one. Not modelled: temperature, wear, play, bending of the frame, side forces.
"""

import math
from collections import deque
from dataclasses import asdict, dataclass
from itertools import accumulate, islice
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.slip.definition import SlipDefinition, slip_ratio
from model.slip.law import SlipLaw, Values
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.errors import ProtocolError
from rig.slip_rig.imperfections import (
    RigImperfections,
    bump_rise,
    lag_one_correlation,
    measured_load,
)
from rig.slip_rig.sweep import SweepPlan

GRID: Final = 1 / 7000
"""Step of the simulation: a load cell's fastest rate [s]."""
MEMORY: Final = 2.0
"""Length of the stored history of true states [s]."""
SLOWEST: Final = 1e-3
"""Surface speed below which the leg disc counts as standing and transmits no force [m/s]."""


@dataclass(frozen=True)
class RigDynamics:
    """Dynamics of the discs; the defaults are a small rig's.

    Attributes:
        speed_lag: Time constant of a disc's exponential approach to its set-point, above 0 [s].
        ripple: Amplitude of the ripple of a disc's speed, as a fraction of the speed [-].
        ripple_order: Periods of the ripple per turn of the disc.

    Raises:
        ProtocolError: `speed_lag` is not above 0, or `ripple` is negative.
    """

    speed_lag: float = 0.05
    ripple: float = 0.0
    ripple_order: int = 6

    def __post_init__(self) -> None:
        if not (self.speed_lag > 0 and self.ripple >= 0):
            raise ProtocolError(
                f"speed_lag is {self.speed_lag:g} s, ripple {self.ripple:g}; expected > 0 s, >= 0"
            )


@dataclass(frozen=True)
class RigTruth:
    """True states of the rig over a stretch of time, one entry for each step of `GRID`.

    Attributes:
        time: Time since the rig was switched on, shape (n,) [s].
        omega_leg: True speed of the leg disc, shape (n,) [rad/s].
        omega_ground: True speed of the ground disc, shape (n,) [rad/s].
        slip: True material slip ratio, from -50 to 50; 0 while the leg disc stands, shape (n,) [-].
        load: True normal force, shape (n,) [N].
        normal: Reading of the normal channel without its white noise, shape (n,) [N].
        traction: Reading of the traction channel, shape (n,) [N].
    """

    time: Array
    omega_leg: Array
    omega_ground: Array
    slip: Array
    load: Array
    normal: Array
    traction: Array


class SimulatedRig:
    """Simulated discs, contact and load cell, which simulated devices advance, command and read.

    Args:
        law: The true slip law, in the material slip ratio.
        values: Values of the law's parameters.
        plan: Radii, and the sweep that the rig drives by itself for as long as no drive commands:
            its slips a `duration` apart, gliding from each to the next.
        imperfections: Sensor errors, noise, slip wander and bump of the ground disc; run-outs and
            `delay` are not simulated.
        dynamics: Dynamics of the discs.
        rng: Random generator.

    Attributes:
        load: Normal force away from the bump [N].
    """

    def __init__(
        self,
        law: SlipLaw = THESIS_LAW,
        values: Values = THESIS_VALUES,
        *,
        plan: SweepPlan,
        imperfections: RigImperfections,
        dynamics: RigDynamics,
        rng: np.random.Generator,
    ) -> None:
        self.load = plan.loads[0]
        self._law = law
        self._values = values
        self._plan = plan
        self._imperfections = imperfections
        self._dynamics = dynamics
        self._rng = rng
        self._offset = rng.normal(0.0, imperfections.offset_sd)
        self._angle = {"leg": 0.0, "ground": float(rng.uniform(0.0, 2 * np.pi))}
        self._omega = {"leg": 0.0, "ground": 0.0}  # without ripple and wander
        self._turning = {"leg": 0.0, "ground": 0.0}  # with them, as encoders see it
        self._target = {"leg": 0.0, "ground": 0.0}
        self._noise = 0.0
        self._wander = 0.0
        self._sweeping = True
        self._switched_on: float | None = None
        self._step = 0
        self._history: deque[RigTruth] = deque()

    def command(self, disc: str, omega: float) -> None:
        """Set the speed of a disc; the first call ends the rig's own sweep.

        The other disc then stops, until its speed is set.

        Args:
            disc: `leg` or `ground`.
            omega: Set-point of its speed [rad/s].
        """
        if self._sweeping:
            self._target = dict.fromkeys(self._target, 0.0)
        self._sweeping = False
        self._target[disc] = omega

    def advance(self, now: float) -> None:
        """Simulate the rig in steps of `GRID` up to `now` by the caller's clock [s].

        The first call switches the rig on.
        """
        if self._switched_on is None:
            self._switched_on = now
        due = math.floor((now - self._switched_on) / GRID + 1e-6)
        most = round(0.1 / GRID)  # set-points of a sweep change between stretches
        while self._step < due:
            stretch = self._run(min(due - self._step, most))
            self._history.append(stretch)
            while stretch.time[-1] - self._history[0].time[-1] > MEMORY:
                self._history.popleft()

    def elapsed(self, now: float) -> float:
        """Return the time from the first `advance` to `now` by the caller's clock; 0 before [s]."""
        return 0.0 if self._switched_on is None else now - self._switched_on

    def truth(self, since: float = 0.0) -> RigTruth:
        """Return the true states, as far back as `MEMORY`.

        Args:
            since: Earliest time of interest since switching on; up to 0.1 s more is returned [s].

        Returns:
            The states from `since`, or the oldest stored one, to now.

        Raises:
            ProtocolError: The rig has not run yet.
        """
        if not self._history:
            raise ProtocolError("the simulated rig has not run yet; advance it first")
        chosen: deque[RigTruth] = deque()
        for stretch in reversed(self._history):
            chosen.appendleft(stretch)
            if stretch.time[0] <= since:
                break
        rows = [list(vars(stretch).values()) for stretch in chosen]
        return RigTruth(*(np.concatenate(column) for column in zip(*rows, strict=True)))

    def forces(self, times: Array) -> tuple[Array, Array]:
        """Return readings of normal force and traction, each of shape (n,) [N].

        A time before or after the history gives its first or last value.

        Args:
            times: Times since switching on, increasing, at least one, shape (n,) [s].

        Raises:
            ProtocolError: The rig has not run yet.
        """
        truth, at = self._states_at(times)
        rig = self._imperfections
        size = rig.load_noise_sd0 + rig.load_noise_sd1 * truth.load[at]
        noise = size * self._rng.standard_normal(len(times)) if size.any() else 0.0
        return truth.normal[at] + noise, truth.traction[at]

    def speeds(self) -> dict[str, tuple[float, float]]:
        """Return (angle [rad], noisy speed [rad/s]) of each disc, by `leg` and `ground`.

        They are those of the last step that `advance` has simulated.
        """
        noise = self._imperfections.speed_noise
        return {
            disc: (self._angle[disc], omega + noise * self._rng.standard_normal())
            for disc, omega in self._turning.items()
        }

    def measured_speeds(self, times: Array) -> tuple[Array, Array]:
        """Return leg and ground speed, with sensor noise, each of shape (n,) [rad/s].

        A time before or after the history has the speed of its first or last step.

        Args:
            times: Times since switching on, increasing, at least one, shape (n,) [s].

        Raises:
            ProtocolError: The rig has not run yet.
        """
        truth, at = self._states_at(times)
        noise = self._imperfections.speed_noise * self._rng.standard_normal((2, len(times)))
        return truth.omega_leg[at] + noise[0], truth.omega_ground[at] + noise[1]

    def description(self) -> dict[str, object]:
        """Return law, values, imperfections, dynamics and traction offset, as plain values."""
        return {
            "law": self._law.name,
            "values": [float(np.asarray(value)) for value in self._values],
            "imperfections": asdict(self._imperfections),
            "dynamics": asdict(self._dynamics),
            "traction_offset": float(self._offset),
        }

    def _states_at(self, times: Array) -> tuple[RigTruth, NDArray[np.intp]]:
        """Return stored states, and the index among them of the one at each time [s]."""
        truth = self.truth(float(times[0]) - GRID)
        return truth, np.clip(np.searchsorted(truth.time, times + GRID / 2) - 1, 0, None)

    def _run(self, n: int) -> RigTruth:
        """Simulate the next n steps of `GRID`, at constant set-points, and return their states."""
        time = np.arange(self._step + 1, self._step + n + 1, dtype=np.float64) * GRID
        self._step += n
        if self._sweeping:
            self._follow_plan(float(time[0]))
        leg = self._turn("leg", n)
        ground = self._turn("ground", n) * self._wandering(n)
        self._turning = {"leg": float(leg[-1]), "ground": float(ground[-1])}
        slip, load, force = self._contact(leg, ground, n)
        gained = (1 + self._imperfections.gain_traction) * force
        traction = gained + self._offset + self._noisy(gained, n)
        normal = measured_load(load, traction, imperfections=self._imperfections)
        return RigTruth(time, leg, ground, slip, load, normal, traction)

    def _follow_plan(self, time: float) -> None:
        """Set load and set-points of the rig's own sweep at a time since switching on [s].

        Slip is interpolated linearly through the plan's slip ratios, one `duration` apart, the last
        held for one, at one load after another, and again from the first.
        """
        loads, slips, duration = self._plan.loads, self._plan.slips, self._plan.duration
        sweep, place = divmod(time / duration, len(slips))
        slip = float(np.interp(place, np.arange(len(slips)), slips))
        self.load = float(loads[int(sweep) % len(loads)])
        self._target = {
            "leg": self._plan.omega_leg,
            "ground": self._plan.speed_leg * (1 - slip) / self._plan.radius_ground,
        }

    def _turn(self, disc: str, n: int) -> Array:
        """Advance a disc by n steps to its set-point; return speeds with ripple, (n,) [rad/s]."""
        target = self._target[disc]
        decay = np.exp(-GRID / self._dynamics.speed_lag * np.arange(1, n + 1))
        smooth = target + (self._omega[disc] - target) * decay
        angle = self._angle[disc] + np.cumsum(smooth) * GRID
        self._omega[disc], self._angle[disc] = float(smooth[-1]), float(angle[-1])
        return smooth * (1 + self._dynamics.ripple * np.sin(self._dynamics.ripple_order * angle))

    def _wandering(self, n: int) -> Array:
        """Draw the factor on the ground speed that makes the slip ratio wander, shape (n,) [-].

        At a slip ratio kappa the wander has the standard deviation `slip_wander_sd`·(1 - kappa).
        """
        rho = lag_one_correlation(GRID, self._imperfections.slip_wander_time)
        path, self._wander = _continue_ar1(rho, self._wander, self._rng, n)
        return 1 - self._imperfections.slip_wander_sd * path

    def _contact(self, leg: Array, ground: Array, n: int) -> tuple[Array, Array, Array]:
        """Compute true slip ratio [-], load and traction [N] at disc speeds [rad/s], shapes (n,).

        While the leg disc stands, slip and traction are 0.
        """
        speed_leg = leg * self._plan.radius_leg
        true_radius = self._plan.radius_ground * (1 + self._imperfections.radius_error)
        speed_ground = ground * true_radius
        moving = np.abs(speed_leg) > SLOWEST
        slip = np.zeros(n)
        slip[moving] = slip_ratio(
            speed_leg[moving], speed_ground[moving], SlipDefinition.MATERIAL
        ).clip(-50.0, 50.0)
        # The disc's angle is already that at the end of the stretch: go back from there.
        angle = self._angle["ground"] - np.cumsum(ground[::-1])[::-1] * GRID
        rise = bump_rise(
            angle, height=self._imperfections.bump_height, width=self._imperfections.bump_width
        )
        load = self.load * (1 + rise)
        resistance = self._imperfections.rolling_resistance * load * np.sign(speed_leg)
        force = self._law.force(slip, load, self._values) - resistance
        return slip, load, np.where(moving, force, 0.0)

    def _noisy(self, force: Array, n: int) -> Array:
        """Draw AR(1) noise of the traction channel, which grows with the force, shape (n,) [N]."""
        size = self._imperfections.noise_sd0 + self._imperfections.noise_sd1 * np.abs(force)
        rho = lag_one_correlation(GRID, self._imperfections.noise_correlation_time)
        path, self._noise = _continue_ar1(rho, self._noise, self._rng, n)
        return size * path


def _continue_ar1(rho: float, last: float, rng: np.random.Generator, n: int) -> tuple[Array, float]:
    """Continue an AR(1) path of unit marginal variance by n steps from its last value.

    `rho` is its correlation from step to step.

    Returns:
        The new values, shape (n,), and the last of them.
    """
    shock = np.sqrt(1 - rho**2) * rng.standard_normal(n)
    # Not by scipy.signal, for whose import every command with a twin would wait.
    steps = accumulate(shock.tolist(), lambda before, step: rho * before + step, initial=last)
    path = np.fromiter(islice(steps, 1, None), dtype=float, count=n)
    return path, float(path[-1])
