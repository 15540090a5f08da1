# SPDX-License-Identifier: MIT
"""Errors that several photographs share: lens, camera's pose, floor marks, robot's marker, height.

They do not average out over the photographs of a walk, and they make the errors of its poses
correlated. What is known of them is one covariance of all of them together, by cause.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from model.arrays import Array

CAMERA = "camera"
"""Key of derivatives by the camera's rotation vector [rad] and translation [m] in a photograph."""
LENS = "lens"
"""Cause: fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-]."""
EDGES = "edges"
"""Cause: how far the edges of all markers lie outwards in the picture, at the usual distance and
more for each step of distance [px] (`tracking.floor.adjustment`)."""
SIDE = "marker side"
"""Cause: side of the robot's marker [m]."""
PLACE = "marker place"
"""Cause: x and y of the robot's marker in the body frame [m]."""
TURN = "marker turn"
"""Cause: yaw of the robot's marker in the body frame [rad]."""
HEIGHT = "body height"
"""Cause: mean height of the body over the walk [m]."""
TILT = "body tilt"
"""Cause: mean roll and pitch of the body over the walk [rad]."""
ANNOTATION = "annotation"
"""Cause: x, y along the body, z [m], roll, pitch and yaw [rad] of the annotated robot, by clicks
and by its height and tilt in that photograph (`tracking.body.annotated`)."""


_ANNOTATED = f"{ANNOTATION} of "

STANDS = "camera's pose"
"""Cause: all of `stand_name`."""
MARKS = "floor marks"
"""Cause: all of `mark_name`."""
_STAND, _MARK = "camera stand ", "floor mark "


def stand_name(stand: int) -> str:
    """Return the cause's name of the camera's pose in a stand, counted from 0."""
    return f"{_STAND}{stand + 1}"


def mark_name(key: int | str) -> str:
    """Return the cause's name of the place of a floor mark, by its number or name."""
    return f"{_MARK}{key}"


def annotation_name(photo: str) -> str:
    """Return the cause's name of the annotation of a photograph, by the photograph's name."""
    return f"{_ANNOTATED}{photo}"


def family_of(cause: str) -> str:
    """Return the family of a cause: `STANDS`, `MARKS`, `ANNOTATION`, or else its own name."""
    families = {_STAND: STANDS, _MARK: MARKS, _ANNOTATED: ANNOTATION}
    return next((name for start, name in families.items() if cause.startswith(start)), cause)


@dataclass(frozen=True)
class SharedErrors:
    """Joint covariance of the errors that photographs share.

    An error is the true value less the value that was used.

    Attributes:
        covariance: Covariance of all errors, shape (q, q); each in the unit of its cause.
        slots: By cause, its rows and columns in `covariance`.
    """

    covariance: Array
    slots: Mapping[str, slice]

    @classmethod
    def none(cls) -> "SharedErrors":
        """Return no shared errors."""
        return cls(np.zeros((0, 0)), {})

    @property
    def size(self) -> int:
        """Number q of scalar errors, such as 9 of a lens and 6 of each stand, over all causes."""
        return len(self.covariance)

    def also(self, cause: str, covariance: Array) -> "SharedErrors":
        """Return the errors with one more cause, independent of the others.

        Args:
            cause: Name of the cause, not yet among `slots`.
            covariance: Covariance of its errors, shape (k, k).
        """
        q, k = self.size, len(covariance)
        joined = np.zeros((q + k, q + k))
        joined[:q, :q], joined[q:, q:] = self.covariance, covariance
        return SharedErrors(joined, {**self.slots, cause: slice(q, q + k)})

    def columns(self, by_cause: Mapping[str, Array], rows: int) -> Array:
        """Place derivatives by cause in the columns of all errors.

        Args:
            by_cause: By cause, derivatives of `rows` values, shape (rows, k). Causes that are not
                among `slots` are taken as exact, and left out.
            rows: Number of rows.

        Returns:
            Derivatives by all errors, shape (rows, q); zero by causes that are not given.
        """
        placed = np.zeros((rows, self.size))
        for cause, derivative in by_cause.items():
            if cause in self.slots:
                placed[:, self.slots[cause]] = derivative
        return placed

    @property
    def root(self) -> Array:
        """Compute A with A A' = `covariance`, without columns of zero variance, shape (q, r).

        The errors are A u, u independent and of variance 1.
        """
        sd = np.sqrt(np.diag(self.covariance))
        unit = np.where(sd > 0, sd, 1.0)
        values, vectors = np.linalg.eigh(self.covariance / np.outer(unit, unit))
        kept = values > 1e-12 * max(float(values.max(initial=0.0)), 1e-300)
        return unit[:, None] * vectors[:, kept] * np.sqrt(values[kept])

    def given(self, causes: Sequence[str]) -> Array:
        """Compute the covariance of all errors if those of some causes were known, shape (q, q).

        Args:
            causes: Names of these causes, keys of `slots`; another name is a KeyError.
        """
        rows = [np.arange(self.size)[self.slots[cause]] for cause in causes]
        known = np.concatenate([np.zeros(0, dtype=int), *rows])
        sd = np.sqrt(np.diag(self.covariance))
        unit = np.where(sd > 0, sd, 1.0)  # pixels beside radians: cut-offs need one unit
        scaled = self.covariance / np.outer(unit, unit)
        with_known = scaled[:, known]
        inverse = np.linalg.pinv(scaled[np.ix_(known, known)], rcond=1e-10, hermitian=True)
        return (scaled - with_known @ inverse @ with_known.T) * np.outer(unit, unit)
