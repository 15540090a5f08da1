# SPDX-License-Identifier: MIT
"""Check the load cell with known weights: fit gain and zero of the normal channel."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import ProtocolError, RigTimeout
from rig.experiment.acquire import PERIOD
from rig.experiment.bench import Bench
from rig.experiment.load import LoadSetter
from rig.experiment.readings import Batch
from rig.experiment.rest import prove_rest
from rig.safety import REST_SPEED
from rig.slip_rig.decode import BATCHES, standard_error

REST_TIMEOUT: Final = 5.0
"""Timeout for the verification that both discs stand [s]."""
SILENCE: Final = 2.0
"""Longest wait for a normal force while the operator hangs a weight [s]."""


@dataclass(frozen=True)
class Weighing:
    """Readings of the load cell under known weights.

    Attributes:
        forces: True forces, the first one 0 for no load, n values [N].
        readings: Mean of the normal channel under each force, n values [N].
        errors: Standard error of each mean, n values [N].
        source: Source of the readings, "real" or "sim:WHAT".
    """

    forces: tuple[float, ...]
    readings: tuple[float, ...]
    errors: tuple[float, ...]
    source: str


@dataclass(frozen=True)
class GainCheck:
    """Linear regression of the readings on the forces: reading = zero + slope·force.

    Attributes:
        slope: Change of the reading per force; 1 where the profile's counts are right [-].
        slope_sd: Standard error of the slope, including the error of the weights [-].
        zero: Reading without load, from the fitted line [N].
        zero_sd: Standard error of the zero [N].
        misfit: Largest difference of a reading from the line, as a magnitude [N].
    """

    slope: float
    slope_sd: float
    zero: float
    zero_sd: float
    misfit: float

    @property
    def gain_sd(self) -> float:
        """Root of (slope - 1)² + slope_sd²: spread of the gain's prior without correction [-]."""
        return float(np.hypot(self.slope - 1, self.slope_sd))

    @property
    def bias_sd(self) -> float:
        """Spread of the bias's prior: largest of zero's error, misfit and 0.001 N [N].

        Each run is tared, so that only the zero's error stays.
        """
        return max(self.zero_sd, self.misfit, 1e-3)


def weigh(
    bench: Bench,
    forces: Sequence[float],
    *,
    load: LoadSetter,
    prompt: Callable[[str, float], None],
    duration: float = 2.0,
    clock: Clock = SYSTEM_CLOCK,
    period: float = PERIOD,
) -> Weighing:
    """Average the normal channel without load and under each weight; nothing is energised.

    Standstill of both discs is verified before each prompt to hang a weight.

    Args:
        bench: The rig, entered.
        forces: Weights in the order in which they are hung [N].
        load: Setter of the load: the operator who hangs the weights.
        prompt: Called repeatedly with the instruction and the present normal force [N].
        duration: Time over which each reading is averaged [s].
        clock: Host time.
        period: Polling period [s].

    Raises:
        NotAtRest: A disc turns, or its speed is unknown.
        RigError: A device or `load` failed, or no normal force arrived for `SILENCE`.
        ProtocolError: Fewer than 2 `BATCHES` forces arrived in `duration`.
    """

    def poll() -> Batch:
        """Wait one period and return the samples that have arrived."""
        clock.sleep(period)
        return bench.read()

    bench.read()  # discard what is in buffers
    readings, errors = [], []
    for force in (0.0, *forces):
        prove_rest(poll, REST_SPEED, longest=REST_TIMEOUT, clock=clock)
        _set_load(poll, load, force, prompt, clock)
        mean, error = _read(poll, duration, clock)
        readings.append(mean)
        errors.append(error)
    return Weighing((0.0, *forces), tuple(readings), tuple(errors), bench.source)


def check_gain(weighing: Weighing, *, weight_sd: float = 1e-3) -> GainCheck:
    """Fit gain and zero of the normal channel: linear regression of readings, weights 1 / error².

    The variances of gain and zero are multiplied by the reduced chi-square where it is above 1.

    Args:
        weighing: Readings under at least two different forces.
        weight_sd: Relative error that all weights share, included in `slope_sd` [-].

    Raises:
        ProtocolError: The forces are all the same.
    """
    force, reading = np.array(weighing.forces), np.array(weighing.readings)
    if np.ptp(force) <= 0:
        raise ProtocolError("every weight is 0 N; expected one above 0 N: check masses and gravity")
    design = np.column_stack([np.ones_like(force), force])
    error = np.maximum(np.array(weighing.errors), 1e-9)  # a simulated cell can be without noise
    weighted = design / error[:, None]
    (zero, slope), *_ = np.linalg.lstsq(weighted, reading / error, rcond=None)
    residuals = reading - design @ np.array([zero, slope])
    freedom = max(len(force) - 2, 1)
    # Residuals above the noise come from weights that hang askew: inflate the covariance by the
    # reduced chi-square where it is above 1.
    scale = max(float(np.sum((residuals / error) ** 2)) / freedom, 1.0)
    covariance = scale * np.linalg.inv(weighted.T @ weighted)
    return GainCheck(
        slope=float(slope),
        slope_sd=float(np.hypot(np.sqrt(covariance[1, 1]), weight_sd * abs(slope))),
        zero=float(zero),
        zero_sd=float(np.sqrt(covariance[0, 0])),
        misfit=float(np.abs(residuals).max()),
    )


def _set_load(
    poll: Callable[[], Batch],
    load: LoadSetter,
    force: float,
    prompt: Callable[[str, float], None],
    clock: Clock,
) -> None:
    """Request a load [N], then poll and prompt until the setter says that it is set.

    Raises:
        RigTimeout: No normal force has been read for `SILENCE`.
    """
    text = load.request(force)
    waiting, heard = True, clock.now()
    while waiting:
        normal = poll().normal
        if len(normal):
            heard = clock.now()
            prompt(text, float(normal.mean()))
            waiting = not load.follow(float(normal.mean()))
        elif clock.now() - heard > SILENCE:
            advice = "check power and cable of the load cell or board"
            raise RigTimeout("no normal force has been read", waited=SILENCE, advice=advice)


def _read(poll: Callable[[], Batch], duration: float, clock: Clock) -> tuple[float, float]:
    """Average the normal force over a duration; return its mean and standard error [N].

    Raises:
        ProtocolError: Fewer than 2 `BATCHES` samples have arrived.
    """
    end = clock.now() + duration
    parts = []
    while clock.now() < end:
        parts.append(poll().normal)
    values = np.concatenate(parts)
    if len(values) < 2 * BATCHES:
        raise ProtocolError(
            f"found {len(values)} force samples in {duration:g} s; expected {2 * BATCHES} or more: "
            "check power and cable of the load cell or board"
        )
    return float(values.mean()), standard_error(values)
