# SPDX-License-Identifier: MIT
"""A place to walk to, and perhaps the heading there."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

ARM = 0.15  # m; lever arm by which an error of heading [rad] counts as a distance


@dataclass(frozen=True)
class Goal:
    """Where a manoeuvre should end, from x, y and yaw zero.

    Attributes:
        x: Distance ahead [m].
        y: Distance to the left [m].
        heading: Heading there; None for any [rad].
    """

    x: float
    y: float
    heading: float | None = None

    def missed(self, pose: Sequence[float]) -> list[float]:
        """Return by how much a pose x, y, yaw misses: along x, y and, if asked, in heading [m].

        Args:
            pose: x and y [m], and yaw, of which whole turns do not count [rad].

        >>> Goal(1.0, 0.0, 0.0).missed((1.1, 0.0, 2 * math.pi))
        [0.10000000000000009, 0.0, 0.0]
        """
        off = [pose[0] - self.x, pose[1] - self.y]
        if self.heading is not None:
            off.append(ARM * math.remainder(pose[2] - self.heading, 2 * math.pi))
        return off
