# SPDX-License-Identifier: MIT
"""How the normal force is set: by a person on a threaded shaft, or at once on a simulated rig."""

import math
from typing import Final, Protocol

from rig.experiment.control import Control
from rig.slip_rig.simulated import SimulatedRig

LEAST: Final = 1e-3
"""Load of an unloaded twin: slip laws are not defined at zero load [N]."""


class LoadSetter(Protocol):
    """Setter of the normal force: `request` once with the target, then `follow` at standstill."""

    def request(self, target: float) -> str:
        """Request a normal force; 0 removes all load.

        Args:
            target: Normal force [N].

        Returns:
            Prompt for the operator; empty where the operator has nothing to do.
        """
        ...

    def follow(self, normal: float) -> bool:
        """Return whether the requested force is set; called with each new normal force.

        Args:
            normal: Normal force, zero subtracted [N].

        Raises:
            RigTimeout: The requested force was not reached in time.
        """
        ...

    def halt(self) -> None:
        """Stop the motion that sets the force; an implementation must not raise."""
        ...


class HandShaft:
    """Load set by an operator, who turns the threaded shaft and confirms.

    A confirmation counts only where the force is within its tolerance. At zero load any force is
    accepted, because the zero of the load cell is not known yet.

    Args:
        control: Mailbox that receives the confirmation.
        tolerance: Largest difference of the normal force from the target [N].
    """

    def __init__(self, control: Control, *, tolerance: float) -> None:
        self._control = control
        self._tolerance = tolerance
        self._target = 0.0

    def request(self, target: float) -> str:
        """Store the target and return the prompt; see `LoadSetter.request`.

        Confirmations given before this prompt are discarded.

        Args:
            target: Normal force; 0 removes all load [N].

        Returns:
            The prompt for the operator.
        """
        self._target = target
        self._control.take_confirmation()  # a confirmation given before this prompt
        if target == 0:
            return "remove all load from the load cell, then confirm"
        within = f" +/- {self._tolerance:g} N" if math.isfinite(self._tolerance) else ""
        return f"set the normal force to {target:g} N{within}, then confirm"

    def follow(self, normal: float) -> bool:
        """Return whether the operator confirmed since the last call, with the force in tolerance.

        At target 0 any force is accepted.

        Args:
            normal: Normal force, zero subtracted [N].
        """
        if not self._control.take_confirmation():
            return False
        return self._target == 0 or abs(normal - self._target) <= self._tolerance

    def halt(self) -> None:
        """Do nothing: the operator stops without a command."""


class SimulatedOperator:
    """Sets the load of a simulated rig exactly and at once; implements the protocol `LoadSetter`.

    Not modelled: the operator's time and mistakes.

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
