# SPDX-License-Identifier: MIT
"""How the normal force is set: by a person on a threaded shaft, or by a driven axis."""

from typing import Final, Protocol

from rig.errors import RigTimeout
from rig.experiment.control import Control

AXIS_PERIOD: Final = 0.3
"""How long a driven axis must keep the force before it counts as set [s]."""


class LoadSetter(Protocol):
    """Whoever sets the normal force; asked once, then followed while the discs stand."""

    def request(self, target: float, *, now: float) -> str:
        """Ask for a force; 0 takes all load away.

        Args:
            target: Normal force [N].
            now: Host time [s].

        Returns:
            What to tell the operator; empty where nobody has to do anything.
        """
        ...

    def follow(self, normal: float, *, now: float) -> bool:
        """Look at the force and tell whether it is set.

        Args:
            normal: Normal force, zero subtracted [N].
            now: Host time [s].

        Raises:
            RigTimeout: It cannot be set.
        """
        ...

    def halt(self) -> None:
        """Move no further; never fails."""
        ...


class HandShaft:
    """A person turns the shaft and confirms.

    A confirmation counts only where the force is within its tolerance. At zero load any force will
    do, because the load cell's zero is what is about to be found.

    Args:
        control: Where the confirmation arrives.
        tolerance: Largest distance from the target [N].
    """

    def __init__(self, control: Control, *, tolerance: float) -> None:
        self._control = control
        self._tolerance = tolerance
        self._target = 0.0

    def request(self, target: float, *, now: float) -> str:
        """Ask for a force; see `LoadSetter.request`."""
        del now
        self._target = target
        self._control.take_confirmation()  # what was said before this prompt
        if target == 0:
            return "take all load off the load cell, then confirm"
        return f"set the normal force to {target:g} N +/- {self._tolerance:g} N, then confirm"

    def follow(self, normal: float, *, now: float) -> bool:
        """Wait for the confirmation; see `LoadSetter.follow`."""
        del now
        if not self._control.take_confirmation():
            return False
        return self._target == 0 or abs(normal - self._target) <= self._tolerance

    def halt(self) -> None:
        """Do nothing: a person stops by themselves."""


class LoadAxis(Protocol):
    """A linear drive that presses the discs together."""

    def move(self, velocity: float) -> None:
        """Command a velocity, positive pressing; 0 holds [m/s]."""
        ...


class DrivenShaft:
    """An axis that presses until the load cell reads the target.

    Args:
        axis: The axis.
        tolerance: Largest distance from the target [N].
        patience: Longest time that setting may take [s].
        gain: Velocity for each newton that is missing [m/(s N)].
        fastest: Largest velocity [m/s].
    """

    def __init__(
        self,
        axis: LoadAxis,
        *,
        tolerance: float,
        patience: float,
        gain: float = 2e-4,
        fastest: float = 2e-3,
    ) -> None:
        self._axis = axis
        self._tolerance = tolerance
        self._patience = patience
        self._gain = gain
        self._fastest = fastest
        self._target = 0.0
        self._asked = self._since = 0.0
        self._lowest = 0.0

    def request(self, target: float, *, now: float) -> str:
        """Ask for a force; see `LoadSetter.request`."""
        self._target = target
        self._asked = self._since = now
        self._lowest = float("inf")
        return ""

    def follow(self, normal: float, *, now: float) -> bool:
        """Press on until the force has been right for a while; see `LoadSetter.follow`."""
        missing = self._target - normal
        if self._target == 0:
            missing = self._withdraw(normal, now)
        elif abs(missing) > self._tolerance:
            self._since = now
        if now - self._asked > self._patience:
            self.halt()
            raise RigTimeout(
                f"the load axis did not bring {self._target:g} N but {normal:.3g} N",
                waited=now - self._asked,
            )
        if now - self._since >= AXIS_PERIOD:
            self.halt()
            return True
        self._axis.move(min(max(self._gain * missing, -self._fastest), self._fastest))
        return False

    def _withdraw(self, normal: float, now: float) -> float:
        """Draw back until the force falls no further: its zero is not known yet."""
        if normal < self._lowest - self._tolerance / 4:
            self._lowest, self._since = normal, now
        return -self._fastest / self._gain

    def halt(self) -> None:
        """Hold the axis."""
        self._axis.move(0.0)
