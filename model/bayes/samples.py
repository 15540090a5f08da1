# SPDX-License-Identifier: MIT
"""The samples of a rig experiment, as arrays."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from model.slip.covariate import Covariate
from model.slip.definition import SlipDefinition
from model.slip.law import Array


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
        covariate: The covariate that runs were made at, and its value in each run, shape (n_runs,),
            in its unit; None without one.
    """

    slip: Array
    normal_force: Array
    traction_force: Array
    run: NDArray[np.intp]
    run_names: tuple[str, ...]
    definition: SlipDefinition
    time: Array | None = None
    covariate: tuple[Covariate, Array] | None = None

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.slip)

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.run_names)

    @property
    def coordinate(self) -> Array | None:
        """Coordinate of the covariate of each sample, shape (n,); None without a covariate."""
        if self.covariate is None:
            return None
        covariate, values = self.covariate
        return covariate.coordinate(values)[self.run]

    def slices(self) -> list[slice]:
        """Return the range of each run's samples, one slice a run, in the order of `run_names`."""
        edges = np.searchsorted(self.run, np.arange(self.n_runs + 1))
        return [slice(int(a), int(b)) for a, b in pairwise(edges)]
