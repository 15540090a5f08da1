# SPDX-License-Identifier: MIT
"""How the normal force is set: by a person on a threaded shaft, or by a driven axis."""

import math
from typing import Final, Protocol

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import RigTimeout
from rig.experiment.control import Control

AXIS_PERIOD: Final = 0.3
"""Time for which a driven axis must keep the force within tolerance [s]."""
GAIN: Final = 2e-4
"""Velocity of a driven axis per newton of force error [m/(s N)]."""
FASTEST: Final = 2e-3
"""Largest velocity of a driven axis [m/s]."""


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


class LoadAxis(Protocol):
    """A linear drive that presses the discs together."""

    def move(self, velocity: float) -> None:
        """Command a velocity, positive pressing; 0 holds [m/s]."""
        ...


class DrivenShaft:
    """Proportional control of a linear axis to a normal force; velocity is `GAIN` times error.

    The error is target minus force; the velocity is at most `FASTEST`. To target 0 the axis
    retracts at `FASTEST`.

    Args:
        axis: Linear drive that presses the discs together.
        tolerance: Largest difference of the normal force from the target [N].
        patience: Timeout of setting a force, from `request` on [s].
        clock: Host time.
    """

    def __init__(
        self, axis: LoadAxis, *, tolerance: float, patience: float, clock: Clock = SYSTEM_CLOCK
    ) -> None:
        self._axis = axis
        self._tolerance = tolerance
        self._patience = patience
        self._clock = clock
        self._target = 0.0
        self._asked = self._since = 0.0
        self._lowest = 0.0

    def request(self, target: float) -> str:
        """Store the target and start its timeout; `follow` moves the axis to it.

        Args:
            target: Normal force; 0 unloads [N].

        Returns:
            An empty text: the operator has nothing to do.
        """
        self._target = target
        self._asked = self._since = self._clock.now()
        self._lowest = float("inf")
        return ""

    def follow(self, normal: float) -> bool:
        """Command a velocity proportional to the force error; halt when the force is set.

        Args:
            normal: Normal force, zero subtracted [N].

        Returns:
            Whether the force has been within its tolerance for `AXIS_PERIOD`; at target 0, whether
            it has not fallen further for that time.

        Raises:
            RigTimeout: `patience` has passed since `request`; the axis has been halted.
        """
        now, missing = self._clock.now(), self._target - normal
        if self._target == 0:
            missing = self._withdraw(normal, now)
        elif abs(missing) > self._tolerance:
            self._since = now
        if now - self._asked > self._patience:
            self.halt()
            raise RigTimeout(
                f"the load axis did not reach {self._target:g} N (it is at {normal:.3g} N)",
                waited=now - self._asked,
                advice="check the axis, or raise load.patience in the plan",
            )
        if now - self._since >= AXIS_PERIOD:
            self.halt()
            return True
        self._axis.move(min(max(GAIN * missing, -FASTEST), FASTEST))
        return False

    def _withdraw(self, normal: float, now: float) -> float:
        """Return a force error [N] that retracts the axis with its largest velocity.

        At host time `now` [s] `AXIS_PERIOD` starts anew if the force has fallen by a quarter of the
        tolerance since it last did: the zero of the load cell is not known yet, so that only the
        end of the fall shows no load.
        """
        if normal < self._lowest - self._tolerance / 4:
            self._lowest, self._since = normal, now
        return -FASTEST / GAIN

    def halt(self) -> None:
        """Command velocity 0, which holds the axis."""
        self._axis.move(0.0)
