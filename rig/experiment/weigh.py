# SPDX-License-Identifier: MIT
"""A load-cell check with known weights: gain and zero of the normal channel, with their errors."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import ProtocolError
from rig.experiment.acquire import PERIOD
from rig.experiment.bench import Bench
from rig.experiment.load import LoadSetter
from rig.experiment.readings import Batch
from rig.experiment.rest import prove_rest
from rig.safety import REST_SPEED

BATCHES: Final = 10
REST_LIMIT: Final = 5.0
"""How long it may take until both discs are proved to stand [s]."""


@dataclass(frozen=True)
class Weighing:
    """What the load cell read under known weights.

    Attributes:
        forces: True forces, zero among them, shape (n,) [N].
        readings: What the normal channel read, shape (n,) [N].
        errors: Standard error of each reading, shape (n,) [N].
    """

    forces: tuple[float, ...]
    readings: tuple[float, ...]
    errors: tuple[float, ...]


@dataclass(frozen=True)
class GainCheck:
    """A straight line through the readings: reading = zero + slope·force.

    Attributes:
        slope: Reading over force; 1 where the profile's counts are right [-].
        slope_sd: Its standard error, that of the weights included [-].
        zero: Reading without load [N].
        zero_sd: Its standard error [N].
        misfit: Largest distance of a reading from the line [N].
    """

    slope: float
    slope_sd: float
    zero: float
    zero_sd: float
    misfit: float

    @property
    def gain_sd(self) -> float:
        """Standard deviation for the gain's prior, as long as the slope is not corrected [-]."""
        return float(np.hypot(self.slope - 1, self.slope_sd))


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
    """Read the normal channel without load and under each weight; nothing is energised.

    Nobody is asked to hang a weight before both discs are proved to stand.

    Args:
        bench: The rig, entered.
        forces: Weights [N].
        load: Who hangs them on.
        prompt: Told again and again what is to be done, and the normal force now [N].
        duration: How long each is read [s].
        clock: Host time.
        period: Between two looks [s].

    Raises:
        NotAtRest: A disc turns, or its speed is not told.
        ProtocolError: The load cell gives too few samples.
    """

    def look() -> Batch:
        clock.sleep(period)
        return bench.read()

    bench.read()  # what lay in buffers
    readings, errors = [], []
    for force in (0.0, *forces):
        prove_rest(look, REST_SPEED, longest=REST_LIMIT, clock=clock)
        text = load.request(force, now=clock.now())
        waiting = True
        while waiting:
            normal = look().normal
            if len(normal):
                prompt(text, float(normal.mean()))
                waiting = not load.follow(float(normal.mean()), now=clock.now())
        mean, error = _read(look, duration, clock)
        readings.append(mean)
        errors.append(error)
    return Weighing((0.0, *forces), tuple(readings), tuple(errors))


def check_gain(weighing: Weighing, *, weight_sd: float = 1e-3) -> GainCheck:
    """Fit gain and zero of the normal channel.

    Args:
        weighing: Readings under at least two different forces.
        weight_sd: Relative error that all weights share [-].

    Raises:
        ProtocolError: The forces are all the same.
    """
    force, reading = np.array(weighing.forces), np.array(weighing.readings)
    if np.ptp(force) <= 0:
        raise ProtocolError("one weight only; expected at least one beside no load")
    design = np.column_stack([np.ones_like(force), force])
    error = np.maximum(np.array(weighing.errors), 1e-9)
    weighted = design / error[:, None]
    (zero, slope), *_ = np.linalg.lstsq(weighted, reading / error, rcond=None)
    left = reading - design @ np.array([zero, slope])
    freedom = max(len(force) - 2, 1)
    # What scatters more than its noise hangs askew: the errors grow with it, and never shrink.
    scale = max(float(np.sum((left / error) ** 2)) / freedom, 1.0)
    covariance = scale * np.linalg.inv(weighted.T @ weighted)
    return GainCheck(
        slope=float(slope),
        slope_sd=float(np.hypot(np.sqrt(covariance[1, 1]), weight_sd * abs(slope))),
        zero=float(zero),
        zero_sd=float(np.sqrt(covariance[0, 0])),
        misfit=float(np.abs(left).max()),
    )


def _read(look: Callable[[], Batch], duration: float, clock: Clock) -> tuple[float, float]:
    """Read for a while; return mean and its error from batch means [N]."""
    end = clock.now() + duration
    parts = []
    while clock.now() < end:
        parts.append(look().normal)
    values = np.concatenate(parts)
    if len(values) < 2 * BATCHES:
        raise ProtocolError(f"{len(values)} samples in {duration:g} s; is the load cell running?")
    means = [batch.mean() for batch in np.array_split(values, BATCHES)]
    return float(values.mean()), float(np.std(means, ddof=1) / np.sqrt(BATCHES))
