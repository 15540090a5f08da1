# SPDX-License-Identifier: MIT
"""Standard deviations that a user states for the poses of another program's track."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.arrays import Array
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.trajectory.table import COVARIANCE

ADVICE = "import the track with --track-sd '1 mm' --track-sd-yaw '0.2 deg', its standard deviations"
"""What to do about a track without covariance that needs one."""


@dataclass(frozen=True)
class PoseSd:
    """Standard deviations of each pose, whose errors are independent of one another.

    Attributes:
        position: Of x and of y [m].
        yaw: Of the heading [rad]; None if not stated.
    """

    position: float
    yaw: float | None = None

    def columns(self, known: Mapping[str, Array], file: Path) -> Mapping[str, Array]:
        """Return columns of a covariance, by name as in `track.csv`, shape (n,) each.

        Args:
            known: Columns of the track in SI.
            file: Its file, for the message.

        Raises:
            SettingsError: The track has a covariance; or a heading, whose standard deviation is not
                stated, or none.
        """
        if set(COVARIANCE) & set(known):
            raise SettingsError(f"{file} has a covariance; leave the option out", key="--track-sd")
        has_yaw = "yaw_rad" in known
        if has_yaw and self.yaw is None:
            raise SettingsError(
                f"{file} has headings; add their standard deviation, such as --track-sd-yaw "
                "'0.2 deg'",
                key="--track-sd-yaw",
            )
        if self.yaw is not None and not has_yaw:
            raise SettingsError(f"{file} has no headings; leave the option out",
                                key="--track-sd-yaw")  # fmt: skip
        one = np.ones_like(known["t_s"])
        variances = {
            "cov_xx": self.position**2, "cov_yy": self.position**2,
            "cov_yawyaw": (self.yaw or 0.0) ** 2,
        }  # fmt: skip
        return {name: variances.get(name, 0.0) * one for name in COVARIANCE}
