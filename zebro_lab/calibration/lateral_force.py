# SPDX-License-Identifier: MIT
"""Mean and scatter of the lateral force that a load cell reports beside load and traction.

Discs that stand square to each other push nothing sideways: a mean that is not small next to
traction shows that they do not, or that the cell's third axis is not zeroed. A calibration does not
use the lateral force otherwise.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.tables.raw_table import is_measured
from zebro_lab.tables.rig_table import RigTable

LATERAL = "lateral_force"
MUCH = 0.1
"""Ratio of mean lateral force to mean traction, both in size, from which a note warns of it [-]."""
_SUMS = 6  # of a run: number, force, its square, force over load, |traction|, and rows in all


@dataclass(frozen=True)
class LateralForce:
    """Lateral force over all samples that have one.

    Attributes:
        samples: Number of samples with a lateral force.
        of: Number of samples in all.
        mean: Mean, with the sign that the data give it [N].
        sd: Standard deviation [N].
        over_load: Mean of lateral force over normal force [-].
        over_traction: Mean over the mean size of traction, with the mean's sign; +infinity without
            any traction [-].
    """

    samples: int
    of: int
    mean: float
    sd: float
    over_load: float
    over_traction: float

    @property
    def text(self) -> str:
        """One line: mean and scatter, and what a mean that is not small may be."""
        part = "" if self.samples == self.of else f" of {self.samples} of {self.of} samples"
        found = (
            f"lateral force{part}: mean {self.mean:.3g} N, standard deviation {self.sd:.3g} N, "
            f"{self.over_load:.2g} of the load"
        )
        if abs(self.over_traction) < MUCH:
            return found
        return (
            f"{found}; the mean is {abs(self.over_traction):.0%} of that of traction, where discs "
            "that are square to each other have none: they may be misaligned, or the load cell's "
            "third axis not zeroed"
        )

    def content(self) -> dict[str, object]:
        """Return the table `lateral_force` of `slip.toml`."""
        return {
            "samples": self.samples, "mean": self.mean, "sd": self.sd,
            "mean_over_load": self.over_load, "mean_over_traction": self.over_traction,
        }  # fmt: skip


def lateral_sums(
    table: RigTable, pressed: Array, traction: Array, run: NDArray[np.intp], n_runs: int
) -> Array | None:
    """Sum what mean and scatter of the lateral force need, by run; None without the column.

    Empty and infinite cells are left out: nothing else depends on them.

    Args:
        table: The table.
        pressed: Normal force of its rows, shape (n,) [N].
        traction: Traction force, shape (n,) [N].
        run: Run of each row, shape (n,).
        n_runs: Number of runs.

    Returns:
        The sums listed at `_SUMS` of each run, to be added up, shape (n_runs, 6).

    Raises:
        DataError: The column is ambiguous, or a cell is not a number.
    """
    source = table.source_of(LATERAL)
    if source is None:
        return None
    force = source.in_si(table.raw)[table.rows]
    there = is_measured(force)
    known = np.where(there, force, 0.0)
    each = (
        there, known, known**2, known / pressed, np.where(there, np.abs(traction), 0.0),
        np.ones(len(force)),
    )  # fmt: skip
    sums = [np.bincount(run, values, minlength=n_runs) for values in each]
    return np.column_stack(sums).astype(np.float64)


def no_sums(samples: NDArray[np.intp]) -> Array:
    """Return sums of runs without a lateral force, of so many samples each, shape (n_runs, 6)."""
    sums = np.zeros((len(samples), _SUMS))
    sums[:, -1] = samples
    return sums


def lateral_force(sums: Sequence[Array]) -> LateralForce | None:
    """Compute mean and scatter over all runs; None where no sample has a lateral force.

    Args:
        sums: Sums of the runs of each table, each of shape (n_runs, 6).
    """
    n, force, square, over_load, traction, every = np.concatenate(sums).sum(axis=0).tolist()
    if n == 0:
        return None
    mean = force / n
    return LateralForce(
        samples=round(n),
        of=round(every),
        mean=mean,
        sd=float(np.sqrt(max(square / n - mean**2, 0.0))),
        over_load=over_load / n,
        over_traction=force / traction if traction > 0 else float("inf"),
    )
