# SPDX-License-Identifier: MIT
"""State machine of a run: its states, whether discs are energised, and the keys that apply."""

from dataclasses import dataclass
from enum import Enum
from typing import Final

from rig.safety import StopCategory


class RigState(Enum):
    """State of a run; docs/experiments.md has the table of its changes."""

    PREPARING = "preparing"
    """Nothing is energised yet."""
    RUNNING = "running"
    """The plan is being carried out."""
    HOLDING = "holding"
    """The discs are held by energised drives until a person resumes the run."""
    STOPPING = "stopping"
    """The discs are ramped to standstill."""
    STOPPED = "stopped"
    """The drives are de-energised; the run is over."""
    LATCHED = "latched"
    """STOPPED after an emergency stop, until a person resets it."""


_STOP_NAMES: Final = {
    StopCategory.SOFT: "soft stop (ramp to standstill, hold energised)",
    StopCategory.SAFE: "safe stop (ramp to standstill, de-energise, end)",
    StopCategory.EMERGENCY: "emergency stop (de-energise at once, latched)",
}
_KEYS: Final = {StopCategory.SOFT: "s", StopCategory.SAFE: "ss", StopCategory.EMERGENCY: "e"}


def next_stop(pending: StopCategory | None) -> StopCategory:
    """Return the stop that the next Ctrl-C requests: one category harder than the pending one.

    Without a pending stop (None) it is the soft stop; after an emergency stop an emergency stop.

    >>> next_stop(StopCategory.SOFT)
    <StopCategory.SAFE: 2>
    """
    return StopCategory(min((pending or 0) + 1, StopCategory.EMERGENCY))


@dataclass(frozen=True)
class Condition:
    """State of a run with its reason.

    Attributes:
        state: State of the run.
        energised: Whether the drives of the discs are energised.
        why: Reason for the state; empty where there is none.
        pending: Hardest stop that was requested and not released; None where there is none.
        hold: Longest duration of a hold, after which a safe stop follows [s].
    """

    state: RigState
    energised: bool
    why: str = ""
    pending: StopCategory | None = None
    hold: float = 0.0

    @property
    def headline(self) -> str:
        """Text with the state, whether discs are energised, and the reason.

        >>> Condition(RigState.HOLDING, True, "soft stop: Ctrl-C").headline
        'HOLDING, discs energised: soft stop: Ctrl-C'
        """
        energy = "discs energised" if self.energised else "discs de-energised"
        return f"{self.state.name}, {energy}" + (f": {self.why}" if self.why else "")

    @property
    def keys(self) -> str:
        """Text with the keys that apply now; each but Ctrl-C is followed by Enter.

        While the run holds it also says when a safe stop follows; after its end, that no key has an
        effect.

        >>> Condition(RigState.STOPPING, True, "", StopCategory.SAFE).keys
        'Ctrl-C or e + Enter: emergency stop (de-energise at once, latched)'
        """
        if self.state in (RigState.STOPPED, RigState.LATCHED):
            return "keys have no effect: the run has ended"
        by_ctrl_c = next_stop(self.pending)
        known = [
            f"{'Ctrl-C or ' if category is by_ctrl_c else ''}{_KEYS[category]} + Enter: {name}"
            for category, name in _STOP_NAMES.items()
            if category > (self.pending or 0) or category is StopCategory.EMERGENCY
        ]
        if self.state is RigState.HOLDING:
            known.insert(0, "r + Enter: resume")
            known.append(f"a safe stop follows unless resumed within {self.hold:g} s")
        elif self.state is RigState.RUNNING:
            known.insert(0, "Enter: confirm a prompt; p + Enter: pause after this point")
        return "; ".join(known)
