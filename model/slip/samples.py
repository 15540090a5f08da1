# SPDX-License-Identifier: MIT
"""The samples of a rig experiment, as arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.slip.definition import SlipDefinition


@dataclass(frozen=True)
class DiscAngles:
    """Recorded angles of the discs, all from one zero of each disc; accumulated or wrapped.

    Attributes:
        leg: Angle of the leg disc at each sample, shape (n,) [rad]; None if not recorded.
        ground: Angle of the ground disc at each sample, shape (n,) [rad]; None if not recorded.
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].
    """

    leg: Array | None
    ground: Array | None
    radius_leg: float
    radius_ground: float

    def of_rows(self, rows: NDArray[np.bool_]) -> "DiscAngles":
        """Return the angles of some samples.

        Args:
            rows: Whether to keep each sample, shape (n,).
        """
        leg, ground = (None if angle is None else angle[rows] for angle in (self.leg, self.ground))
        return replace(self, leg=leg, ground=ground)


@dataclass(frozen=True)
class SlipSamples:
    """Slip, load and traction of every sample, in time order within each run.

    A run is one stretch of recording under one zero of the load cell: samples of a run share an
    unknown force offset and are correlated in time; runs are independent.

    Attributes:
        slip: Instantaneous slip ratio in `definition`, shape (n,) [-].
        normal_force: Measured normal force, positive when pressed together, shape (n,) [N].
        traction_force: Measured traction force, positive when driving, shape (n,) [N].
        run: Index into `run_names`, non-decreasing, shape (n,).
        run_names: Name of each run, as its user would recognise it.
        definition: Definition of the slip ratios: the speed that they are divided by.
        time: Time of each sample, increasing within a run, shape (n,) [s]; None for samples
            without times (averages over a trial).
        angles: Angles of the discs; None where none are recorded.
        force_sd: Standard deviation of each sample's traction force, as of a mean over a trial,
            shape (n,) [N]; None where none is stated.
        others: Further columns of the data by name, which differ between runs: a fit does not use
            them, and asks whether they explain what it leaves, shape (n,) each.
    """

    slip: Array
    normal_force: Array
    traction_force: Array
    run: NDArray[np.intp]
    run_names: tuple[str, ...]
    definition: SlipDefinition
    time: Array | None = None
    angles: DiscAngles | None = None
    force_sd: Array | None = None
    others: Mapping[str, Array] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.slip)

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.run_names)

    def slices(self) -> list[slice]:
        """Return the range of each run's samples, one slice a run, in the order of `run_names`."""
        edges = np.searchsorted(self.run, np.arange(self.n_runs + 1))
        return [slice(int(a), int(b)) for a, b in pairwise(edges)]
