# SPDX-License-Identifier: MIT
"""Faults of simulated slip rigs, each in five sizes, and the causes that are right to name.

A fault changes a session (`benchmarks.accuracy.stranger_rigs`): what was the case before it is
recorded, or the record. Sizes go from hardly visible to gross.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CAUSES = (  # the closed list; a fault's causes are those of it that its data do not rule out
    "force zero",  # wrong, or drifts
    "slip zero",  # also the radii of all runs or of some
    "force scale",  # sign, unit, gain
    "one direction",  # driving and braking are measured differently
    "load column",  # of another sensor, late, not what the contact feels
    "crosstalk",
    "timing",  # of slip and force: delay, clock, filter, averaging
    "slip definition",
    "saturation",
    "frozen samples",
    "outliers",
    "stick-slip",
    "friction over time",  # wear, temperature, or anything else that drifts over the runs
    "two materials",
    "hidden variable",
    "noise model",
    "hysteresis",
)


@dataclass
class Session:
    """Runs of a rig, arrays of shape (runs, samples): what was the case, and the record of it.

    `law` gives traction over load at a slip, with slope `K` and peak `mu`. `path` is the slip that
    was set; `slip`, `load` and `traction` were the case, `largest` [N] the largest traction. `k`,
    `fz` and `fx` are the record: slip ratio [-], normal and traction force [N].
    """

    law: Callable[[Array], Array]
    K: float
    mu: float
    t: Array
    path: Array
    slip: Array
    load: Array
    traction: Array
    largest: float
    k: Array = field(default_factory=lambda: np.empty(0))
    fz: Array = field(default_factory=lambda: np.empty(0))
    fx: Array = field(default_factory=lambda: np.empty(0))
    extra: dict[str, Array] = field(default_factory=dict)

    def progress(self, like: Array) -> Array:
        """Return the elapsed share of the session [-], in the shape of `like`."""
        return np.arange(like.size).reshape(like.shape) / like.size


Act = Callable[[Session, float, np.random.Generator], None]


@dataclass(frozen=True)
class Fault:
    """A fault; `needs` says what a design must have to show it, `before` that it is no record's."""

    act: Act
    right: tuple[str, ...]
    changes: str
    sizes: tuple[float, ...]
    needs: str = ""
    before: bool = False


FAULTS: dict[str, Fault] = {}


def fault(changes: str, right: str, *sizes: float, needs: str = "", before: bool = False):
    """Enter a fault, with the column that it changes and its right causes (separated by commas)."""

    def enter(act: Act) -> Act:
        causes = tuple(right.split(", "))
        FAULTS[act.__name__] = Fault(act, causes, changes, sizes, needs, before)
        return act

    return enter


def exponential(slip: Array, K: float, mu: float) -> Array:
    """Compute traction over load of a second material, mu (1 - exp(-K|k|/mu)), odd in k."""
    return mu * np.sign(slip) * (1 - np.exp(-K * np.abs(slip) / mu))


def read_at(rows: Array, where: Array) -> Array:
    """Interpolate each row at fractional sample numbers; beyond the ends its end values stay."""
    return np.array([np.interp(where, np.arange(row.size), row) for row in rows])


def some_rows(rows: Array, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return the numbers of `count` rows (at least one) at random, in order."""
    return np.sort(rng.permutation(len(rows))[: max(count, 1)])


@fault("fx", "force zero, friction over time", 0.01, 0.03, 0.1, 0.2, 0.4)
def zero_drift(s: Session, size: float, _: np.random.Generator) -> None:
    """The zero of traction drifts over the session by a share of the largest."""
    s.fx = s.fx + size * s.largest * s.progress(s.fx)


@fault("k", "slip zero, force zero", 0.002, 0.005, 0.01, 0.02, 0.05)
def slip_zero(s: Session, size: float, _: np.random.Generator) -> None:
    """All slip ratios read too high, as with a wrong radius."""
    s.k = s.k + size


@fault("fx", "force scale, friction over time, two materials", 1.05, 1.2, 2.0, -1.0, 9.81)
def wrong_unit(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction of the second half of the runs is multiplied: range, sign or unit of an export."""
    s.fx = s.fx * np.where(np.arange(len(s.fx)) < len(s.fx) // 2, 1.0, size)[:, None]


@fault("fx", "one direction, force scale", 0.02, 0.05, 0.1, 0.2, 0.4, needs="signs")
def gain_one_way(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction is too small by a share where the disc brakes."""
    s.fx = np.where(s.fx < 0, 1 - size, 1.0) * s.fx


@fault("fz", "load column", 0.05, 0.15, 0.4, 0.7, 1.0, needs="loads")
def load_elsewhere(s: Session, size: float, _: np.random.Generator) -> None:
    """The load's sensor misses a share of its changes; at 1 the column is constant."""
    s.fz = (1 - size) * s.fz + size * s.fz.mean()


@fault("fz", "load column, timing", 0.02, 0.05, 0.15, 0.4, 1.0, needs="loads")
def load_late(s: Session, size: float, _: np.random.Generator) -> None:
    """The load column is late by a share of a run, the runs following one another."""
    late = read_at(s.fz.reshape(1, -1), np.arange(s.fz.size) - size * s.fz.shape[1])
    s.fz = late.reshape(s.fz.shape)


@fault("fz", "crosstalk, load column", 0.01, 0.03, 0.1, 0.2, 0.4)
def crosstalk(s: Session, size: float, _: np.random.Generator) -> None:
    """The normal force takes in a share of the traction."""
    s.fz = s.fz + size * s.fx


@fault("fx", "timing, slip zero, hysteresis", 0.002, 0.005, 0.015, 0.04, 0.1, needs="sweeps")
def delay(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction is late behind slip by a share of a sweep."""
    samples = s.fx.shape[1]
    s.fx = read_at(s.fx, np.arange(samples) - size * samples)


@fault("fx", "timing, slip zero, hysteresis", 0.005, 0.015, 0.05, 0.1, 0.3, needs="sweeps")
def clock_stretched(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction's clock is fast: traction lags by a share of the time since a sweep began."""
    s.fx = read_at(s.fx, np.arange(s.fx.shape[1]) / (1 + size))


@fault("fx", "timing, slip zero, hysteresis", 0.003, 0.01, 0.03, 0.1, 0.3, needs="sweeps")
def force_filtered(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction passes a filter of first order, whose time constant is a share of a sweep."""
    keep, fx = np.exp(-1 / (size * s.fx.shape[1])), s.fx.copy()
    for n in range(1, fx.shape[1]):
        fx[:, n] = keep * fx[:, n - 1] + (1 - keep) * fx[:, n]
    s.fx = fx


@fault("k", "timing", 0.03, 0.1, 0.25, 0.5, 1.0, needs="sweeps")
def slip_averaged(s: Session, size: float, _: np.random.Generator) -> None:
    """Slip is a moving mean over a share of a sweep."""
    half, samples = max(round(size * s.k.shape[1] / 2), 1), np.arange(s.k.shape[1])
    shifts = range(-half, half + 1)
    s.k = np.mean([read_at(s.k, samples + shift) for shift in shifts], axis=0)


@fault("k", "slip definition, two materials", 0.05, 0.2, 0.5, 0.75, 1.0)
def definition(s: Session, size: float, rng: np.random.Generator) -> None:
    """A share of the runs has slip over the ground's speed, k/(1 - k)."""
    runs, k = some_rows(s.k, round(size * len(s.k)), rng), s.k.copy()
    k[runs] = k[runs] / (1 - k[runs])
    s.k = k


@fault("fx", "saturation", 0.95, 0.85, 0.7, 0.5, 0.3)
def saturation(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction is cut off at a share of the largest that would be recorded."""
    limit = size * np.abs(s.fx).max()
    s.fx = s.fx.clip(-limit, limit)


@fault("fx", "frozen samples, timing", 0.02, 0.05, 0.15, 0.4, 0.8, needs="samples")
def frozen(s: Session, size: float, rng: np.random.Generator) -> None:
    """Traction keeps its value for ten samples, in a share of such stretches."""
    n = np.arange(s.fx.shape[1])
    stuck = rng.random(s.fx.shape)[:, n // 10] < size
    s.fx = np.where(stuck, s.fx[:, n - n % 10], s.fx)


@fault("fx", "outliers", 0.001, 0.005, 0.02, 0.07, 0.2)
def outliers(s: Session, size: float, rng: np.random.Generator) -> None:
    """A share of the values of traction (at least one) is off by about its largest."""
    off = some_rows(s.fx.ravel(), round(size * s.fx.size), rng)
    fx = s.fx.ravel().copy()
    fx[off] += s.largest * rng.normal(size=off.size)
    s.fx = fx.reshape(s.fx.shape)


@fault("fx", "stick-slip, noise model", 0.02, 0.035, 0.05, 0.07, 0.1, needs="samples")
def stick_slip(s: Session, size: float, rng: np.random.Generator) -> None:
    """Traction has a saw-tooth of 2 to 6 Hz, whose amplitude is a share of it."""
    hertz, phase = rng.uniform([[2], [0]], [[6], [1]], (2, len(s.fx)))[..., None]
    s.fx = s.fx * (1 + size * (2 * ((hertz * s.t + phase) % 1) - 1))


@fault("fx", "friction over time, hidden variable", 0.02, 0.05, 0.1, 0.2, 0.4, before=True)
def wear(s: Session, size: float, _: np.random.Generator) -> None:
    """Friction falls evenly over the session by a share."""
    s.traction = s.traction * (1 - size * s.progress(s.traction))


@fault("fx", "two materials, hidden variable", 0.05, 0.15, 0.4, 0.7, 1.0, before=True)
def two_materials(s: Session, size: float, rng: np.random.Generator) -> None:
    """Half of the runs, at random, has a curve on the way to an exponential one of K/2 and 2 mu."""
    runs = some_rows(s.slip, len(s.slip) // 2, rng)
    second = s.load[runs] * exponential(s.slip[runs], s.K / 2, 2 * s.mu)
    s.traction[runs] += size * (second - s.traction[runs])


@fault("fx", "hidden variable, two materials, friction over time",
       0.02, 0.05, 0.1, 0.2, 0.4, before=True)  # fmt: skip
def temperature(s: Session, size: float, rng: np.random.Generator) -> None:
    """Friction falls by a share for 10 °C, drawn for each run; that column is not mapped."""
    z = rng.uniform(-1.7, 1.7, (len(s.slip), 1))
    s.traction = s.traction * (1 - size * z / 2)
    s.extra["temperature [degC]"] = 25 + 5 * z


@fault("k", "slip zero, force zero", 0.005, 0.01, 0.03, 0.08, 0.2)
def odd_radius(s: Session, size: float, rng: np.random.Generator) -> None:
    """Each tenth run (at least one) had a leg disc whose radius was smaller by a share."""
    runs, k = some_rows(s.k, len(s.k) // 10, rng), s.k.copy()
    k[runs] = 1 - (1 - k[runs]) * (1 - size)
    s.k = k


@fault("fx", "noise model", 0.02, 0.05, 0.1, 0.2, 0.4)
def noise_grows(s: Session, size: float, rng: np.random.Generator) -> None:
    """Traction has further white noise, a share of its amount."""
    s.fx = s.fx * (1 + size * rng.normal(size=s.fx.shape))


@fault("fx", "hysteresis, timing", 0.002, 0.005, 0.01, 0.02, 0.05, needs="turns", before=True)
def hysteresis(s: Session, size: float, _: np.random.Generator) -> None:
    """Traction is that of a slip lagging by half of a play, upwards and downwards of a sweep."""
    s.traction = s.load * s.law(s.slip - size / 2 * np.sign(np.gradient(s.path, axis=1)))
