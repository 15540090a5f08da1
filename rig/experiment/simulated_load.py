# SPDX-License-Identifier: MIT
"""Normal force of a simulated rig: set exactly, or by a linear axis behind a spring.

Not modelled: the operator's time and mistakes; friction, play and inertia of the axis.
"""

from typing import Final

from rig.clock import Clock
from rig.slip_rig.simulated import SimulatedRig

LEAST: Final = 1e-3
"""Load of an unloaded twin: slip laws are not defined at zero load [N]."""


class SimulatedOperator:
    """Sets the load exactly and at once; implements the protocol `LoadSetter`.

    Args:
        rig: Simulated rig whose load is set.
    """

    def __init__(self, rig: SimulatedRig) -> None:
        self._rig = rig

    def request(self, target: float) -> str:
        """Set the rig's load at once, to at least `LEAST`; see `LoadSetter.request`.

        Args:
            target: Normal force [N].

        Returns:
            An empty text: the operator has nothing to do.
        """
        self._rig.load = max(target, LEAST)
        return ""

    def follow(self, normal: float) -> bool:
        """Return True: the load is set at once.

        Args:
            normal: Normal force, not used [N].
        """
        del normal
        return True

    def halt(self) -> None:
        """Do nothing: no motion has to be stopped."""


class SimulatedAxis:
    """Linear drive that loads the rig through a spring; implements the protocol `LoadAxis`.

    Args:
        rig: Simulated rig whose discs the drive presses together.
        stiffness: Spring stiffness [N/m].
        clock: Host time.
    """

    def __init__(self, rig: SimulatedRig, *, stiffness: float = 5e3, clock: Clock) -> None:
        self._rig = rig
        self._stiffness = stiffness
        self._clock = clock
        self._velocity = 0.0
        self._moved = clock.now()

    def move(self, velocity: float) -> None:
        """Command a velocity, positive pressing [m/s].

        The load first changes by stiffness times the way since the last command, to at least
        `LEAST`; between commands it stays.
        """
        now = self._clock.now()
        moved = self._velocity * (now - self._moved)
        self._rig.load = max(self._rig.load + self._stiffness * moved, LEAST)
        self._velocity, self._moved = velocity, now
