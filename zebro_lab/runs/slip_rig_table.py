# SPDX-License-Identifier: MIT
"""Samples of the slip rig in SI."""

from dataclasses import dataclass, fields
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

COLUMNS: Final = ("t", "omega_leg", "omega_ground", "normal_force", "traction_force")
"""Columns that every run has."""


@dataclass(frozen=True)
class SlipRigTable:
    """Samples of one run of the slip rig, SI; each attribute has shape (n,).

    Attributes:
        t: Time since the start of the run [s].
        omega_leg: Angular speed of the leg disc [rad/s].
        omega_ground: Angular speed of the ground disc [rad/s].
        normal_force: Normal force, positive when pressed together [N].
        traction_force: Traction force, positive when driving [N].
        lateral_force: Force on the load cell's third axis, with its sign; None if not measured [N].
        angle_leg: Angle of the leg disc [rad]; None where none was recorded.
        angle_ground: Angle of the ground disc [rad]; None where none was recorded.
    """

    t: Array
    omega_leg: Array
    omega_ground: Array
    normal_force: Array
    traction_force: Array
    lateral_force: Array | None = None
    angle_leg: Array | None = None
    angle_ground: Array | None = None

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.t)

    def rows(self) -> Array:
        """Return the samples by rows with the columns `COLUMNS`, shape (n, 5)."""
        return np.column_stack([getattr(self, name) for name in COLUMNS])

    def measured(self) -> dict[str, Array]:
        """Return the columns that are not None, by name."""
        every = {each.name: getattr(self, each.name) for each in fields(self)}
        return {name: values for name, values in every.items() if values is not None}

    def select(self, rows: NDArray[np.bool_]) -> "SlipRigTable":
        """Return some of the samples.

        Args:
            rows: Whether to keep each, shape (n,).
        """
        return SlipRigTable(**{name: values[rows] for name, values in self.measured().items()})
