# SPDX-License-Identifier: MIT
"""The leg angles that a walk was asked for: those of a gait, or of a program."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from model.gait import CyclicReference, EventSystem, SampledReference
from model.gait.direction import Direction
from model.gait.stance import Intervals


@dataclass(frozen=True)
class WalkedSegment:
    """A segment of a walked program, for a table.

    Attributes:
        what: Gait and turn, or "stand".
        cycles: Number of cycles; 0 of a stand.
        end: Time of its end [s].
    """

    what: str
    cycles: int
    end: float


@dataclass(frozen=True)
class AskedWalk:
    """Leg angles to walk.

    Attributes:
        reference: The angles over time.
        duration: Time to walk [s].
        what: Name of gait or program, for titles.
        settings: What was asked for, JSON-serialisable, for the manifest.
        direction: Side that the gait turns to.
        schedule: The max-plus system of a gait's events; None for others.
        segments: Of a program, where each segment ended.
        stances: Of a program, when each leg stands; None for others.
        files: Files that were read.
        notes: Notes, one line each.
    """

    reference: CyclicReference | SampledReference
    duration: float
    what: str
    settings: Mapping[str, object]
    direction: Direction = "left"
    schedule: EventSystem | None = None
    segments: tuple[WalkedSegment, ...] = ()
    stances: Intervals | None = None
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()
