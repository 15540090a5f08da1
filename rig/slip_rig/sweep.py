# SPDX-License-Identifier: MIT
"""Set-points of a sweep of the two-disc rig: every slip ratio at every load."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.errors import DomainError


def _require(holds: bool, name: str, value: float, expected: str) -> None:
    """Raise a DomainError with name and value of a set-point where a condition does not hold."""
    if not holds:
        raise DomainError(f"{name} is {value:g}; expected {expected}")


@dataclass(frozen=True)
class SweepPlan:
    """Set-points of a sweep: each slip ratio at each load, the loads outermost, one run a point.

    The defaults are the rig of the Thesis (section 4-6): 62 slip ratios, four loads.

    Attributes:
        slips: Material slip ratios, Eq. (4-44), at most 1 [-].
        loads: Normal forces away from the ground disc's bump, above 0 [N].
        duration: Duration of a run, one for each slip ratio at each load [s].
        rate: Sample rate [Hz].
        omega_leg: Speed of the leg disc [rad/s].
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].

    Raises:
        DomainError: A run has fewer than two samples, a slip ratio is above 1, or another number
            is not above 0.

    >>> SweepPlan().n_runs, SweepPlan().n_samples
    (248, 250)
    """

    slips: tuple[float, ...] = tuple(np.linspace(0.0, 1.0, 62).tolist())
    loads: tuple[float, ...] = (2.13, 6.63, 8.13, 12.75)
    duration: float = 1.0
    rate: float = 250.0
    omega_leg: float = 12.0
    radius_leg: float = 0.035
    radius_ground: float = 0.12

    def __post_init__(self) -> None:
        for name in ("duration", "rate", "omega_leg", "radius_leg", "radius_ground"):
            _require(getattr(self, name) > 0, name, getattr(self, name), "above 0")
        for load in self.loads:
            _require(load > 0, "loads", load, "above 0 N")
        for slip in self.slips:
            _require(slip <= 1, "slips", slip, "at most 1, where the ground disc stands still")
        _require(self.n_samples >= 2, "duration·rate", self.n_samples, "at least 2 samples a run")

    @property
    def n_runs(self) -> int:
        """Number of runs: loads times slip ratios."""
        return len(self.loads) * len(self.slips)

    @property
    def n_samples(self) -> int:
        """Number of samples of one run: duration times rate, rounded."""
        return round(self.duration * self.rate)

    @property
    def speed_leg(self) -> float:
        """Compute the surface speed of the leg disc, v_l = omega_l·r_l, Eq. (4-43) [m/s]."""
        return self.omega_leg * self.radius_leg

    def set_points(self) -> tuple[Array, Array]:
        """Return commanded load [N] and slip ratio [-] of every run, each of shape (runs,).

        The slip ratio changes from run to run, the load after all slip ratios.
        """
        load, slip = np.meshgrid(self.loads, self.slips, indexing="ij")
        return load.ravel(), slip.ravel()

    def run_names(self) -> tuple[str, ...]:
        """Return the name of every run, with load and slip ratio, in the order of `set_points`."""
        return tuple(
            f"Fn {load:g} N, slip {slip:.4f}" for load, slip in zip(*self.set_points(), strict=True)
        )
