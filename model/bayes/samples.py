# SPDX-License-Identifier: MIT
"""The samples of a rig experiment, as arrays."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from model.slip.definition import SlipDefinition, convert_slip
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
        definition: What the slip ratios are divided by.
        time: Time of each sample, increasing within a run, shape (n,) [s]; None where samples
            carry none (averages over a trial).
    """

    slip: Array
    normal_force: Array
    traction_force: Array
    run: NDArray[np.intp]
    run_names: tuple[str, ...]
    definition: SlipDefinition
    time: Array | None = None

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.slip)

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.run_names)

    def slices(self) -> list[slice]:
        """Return one slice a run."""
        edges = np.searchsorted(self.run, np.arange(self.n_runs + 1))
        return [slice(int(a), int(b)) for a, b in pairwise(edges)]

    def sample_interval(self) -> float | None:
        """Return the median time between samples of one run, None without time stamps [s]."""
        if self.time is None:
            return None
        steps = np.diff(self.time)[np.diff(self.run) == 0]
        return float(np.median(steps)) if len(steps) else None

    def with_definition(self, definition: SlipDefinition | str) -> "SlipSamples":
        """Return the same samples with their slip ratios in another definition."""
        slip = convert_slip(self.slip, self.definition, definition)
        return SlipSamples(
            slip, self.normal_force, self.traction_force, self.run, self.run_names,
            SlipDefinition(definition), self.time,
        )  # fmt: skip

    def only_runs(self, keep: NDArray[np.bool_]) -> "SlipSamples":
        """Return the samples of some runs.

        Args:
            keep: Which runs to keep, shape (n_runs,).
        """
        rows = keep[self.run]
        renumbered = np.cumsum(keep) - 1
        return SlipSamples(
            self.slip[rows], self.normal_force[rows], self.traction_force[rows],
            renumbered[self.run[rows]], tuple(np.array(self.run_names, dtype=object)[keep]),
            self.definition, None if self.time is None else self.time[rows],
        )  # fmt: skip
