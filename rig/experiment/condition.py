# SPDX-License-Identifier: MIT
"""What state a run is in, whether the discs are energised, and which key does what next."""

from dataclasses import dataclass
from enum import Enum
from typing import Final

from rig.safety import StopCategory


class RigState(Enum):
    """State of a run; docs/experiments.md has the table of its changes."""

    PREPARING = "preparing"
    """Nothing is energised yet."""
    RUNNING = "running"
    """The plan is gone through."""
    HOLDING = "holding"
    """The discs stand, energised, until somebody lets the run go on."""
    STOPPING = "stopping"
    """The discs are ramped to standstill."""
    STOPPED = "stopped"
    """The drives are de-energised; the run is over."""
    LATCHED = "latched"
    """The same after an emergency stop, which somebody has to reset."""


_STOP_NAMES: Final = {
    StopCategory.SOFT: "soft stop (ramp to standstill, hold energised)",
    StopCategory.SAFE: "safe stop (ramp to standstill, de-energise, end)",
    StopCategory.EMERGENCY: "emergency stop (de-energise at once, latched)",
}
_KEYS: Final = {StopCategory.SOFT: "s", StopCategory.SAFE: "ss", StopCategory.EMERGENCY: "e"}


def next_stop(pending: StopCategory | None) -> StopCategory:
    """Return what the next Ctrl-C asks for: the stop that is one step harder.

    >>> next_stop(StopCategory.SOFT)
    <StopCategory.SAFE: 2>
    """
    return StopCategory(min((pending or 0) + 1, StopCategory.EMERGENCY))


@dataclass(frozen=True)
class Condition:
    """What state a run is in.

    Attributes:
        state: The state.
        energised: Whether the drives of the discs are energised.
        why: What brought the run there; empty where nothing did.
        pending: The hardest stop that is being obeyed; None where there is none.
        hold: How long a hold lasts before a safe stop follows [s].
    """

    state: RigState
    energised: bool
    why: str = ""
    pending: StopCategory | None = None
    hold: float = 0.0

    @property
    def headline(self) -> str:
        """Say state, energy and reason in words.

        >>> Condition(RigState.HOLDING, True, "soft stop: Ctrl-C, time 1").headline
        'HOLDING, discs energised: soft stop: Ctrl-C, time 1'
        """
        energy = "discs energised" if self.energised else "discs de-energised"
        return f"{self.state.name}, {energy}" + (f": {self.why}" if self.why else "")

    @property
    def keys(self) -> str:
        """Say which key does what next; each but Ctrl-C is followed by Enter.

        >>> Condition(RigState.STOPPING, True, "", StopCategory.SAFE).keys
        'Ctrl-C or e: emergency stop (de-energise at once, latched)'
        """
        if self.state in (RigState.STOPPED, RigState.LATCHED):
            return "no key does anything any more: the run is over"
        by_ctrl_c = next_stop(self.pending)
        known = [
            f"{'Ctrl-C or ' if category is by_ctrl_c else ''}{_KEYS[category]}: {name}"
            for category, name in _STOP_NAMES.items()
            if category > (self.pending or 0) or category is StopCategory.EMERGENCY
        ]
        if self.state is RigState.HOLDING:
            known.insert(0, "r: go on")
            known.append(f"without a word a safe stop follows after {self.hold:g} s")
        elif self.state is RigState.RUNNING:
            known.insert(0, "Enter: confirm a prompt; p: pause after this point")
        return "; ".join(known)
