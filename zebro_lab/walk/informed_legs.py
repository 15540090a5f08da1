# SPDX-License-Identifier: MIT
"""Select the posterior of legs and floor that applies to a given walk."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.leg_state import LegState
from model.walk_fit.posterior import WalkPosterior
from zebro_lab.calibration.walks_folder import StoredWalks, describe_legs
from zebro_lab.files.provenance import file_hash
from zebro_lab.robot.robot_file import RobotFile

_OF_MIDDLE = {
    "leg_arc_beyond": "arc", "grip": "grip", "slip_stiffness": "stiffness", "fall": "fall",
    "lateral_grip": "lateral_grip", "lateral_stiffness": "lateral_stiffness",
    "steering": "steering", "stride": "stride",
}  # fmt: skip
"""Names in a manifest of the values of a state of legs and floor."""
_SEED = 1  # for another robot's legs, which are drawn from the prior


@dataclass(frozen=True)
class InformedLegs:
    """Posterior of legs and floor, as it applies to one walk.

    Attributes:
        posterior: Posterior of leg offsets and floor; for legs other than the fitted ones that of
            the floor alone, with legs drawn from the prior.
        index: Index of this walk among the fitted walks; None for a new walk.
        folder: The folder `walks/` that the posterior was read from.
        source: Sources of the walks and of the slip law that they were fitted with.
        notes: Notes, one line each.
        doubts: A warning if the fit is not reliable, one of the notes; else empty.
    """

    posterior: WalkPosterior
    index: int | None
    folder: Path
    source: str
    notes: tuple[str, ...]
    doubts: tuple[str, ...] = ()

    @property
    def middle(self) -> LegState:
        """The most probable state of legs and floor for this walk, a single draw."""
        return self.posterior.most_likely(walk=self.index)

    def draw(self, n: int, *, rng: np.random.Generator) -> LegState:
        """Draw n states of legs and floor for this walk from the posterior.

        Args:
            n: Number of draws.
            rng: Random number generator.
        """
        return self.posterior.draw(n, rng=rng, walk=self.index)

    def settings(self) -> dict[str, object]:
        """Return folder, source, walks, this walk and `middle`'s values, JSON-serialisable, SI.

        `this_walk` is the name of the fitted walk that this is; None for a new one.
        """
        legs = self.middle
        return {
            "folder": str(self.folder),
            "source": self.source,
            "walks": list(self.posterior.walks),
            "this_walk": None if self.index is None else self.posterior.walks[self.index],
            "leg_offset": legs.offset[0].tolist(),
            **{name: float(getattr(legs, each)[0]) for name, each in _OF_MIDDLE.items()},
        }


def informed_legs(
    walks: StoredWalks,
    described: RobotFile,
    *,
    logs: Sequence[Path] = (),
    same_legs: bool | None = None,
) -> InformedLegs:
    """Select the part of a posterior that applies to a walk: legs and floor, or the floor alone.

    Args:
        walks: The stored posterior of legs and floor.
        described: Parameters of the robot that walks.
        logs: Files of the walk's leg log, by whose hash a fitted walk is recognised; missing ones
            are skipped.
        same_legs: None to compare the legs' parameters with those of the robot that was fitted:
            where they are equal legs and floor apply, else the floor alone. False if the leg angles
            are exact, as those of a walk folder, and need no offset: the floor alone applies. True
            to apply legs and floor to any robot.
    """
    same = walks.legs == describe_legs(described) if same_legs is None else same_legs
    names = ", ".join(walks.posterior.walks)
    if not same:
        floor = walks.posterior.of_floor_alone(rng=np.random.default_rng(_SEED))
        why = "another robot walked them" if same_legs is None else "the leg angles are exact"
        note = f"walks: of the fit to {names} the floor alone is used, since {why}"
        return InformedLegs(
            floor, None, walks.folder, walks.source, (note, *walks.doubts), walks.doubts
        )
    index = _index(walks, logs)
    notes = [f"walks: legs and floor are those fitted to {names}"]
    if index is not None:
        notes.append(
            f"walks: {walks.posterior.walks[index]} is this walk: the prediction was fitted to its "
            "own track, which is therefore no independent test"
        )
    return InformedLegs(
        walks.posterior, index, walks.folder, walks.source, (*notes, *walks.doubts), walks.doubts
    )


def _index(walks: StoredWalks, logs: Sequence[Path]) -> int | None:
    """Return the index of the fitted walk with one of these leg logs, by hash; None if none has."""
    hashes = {file_hash(file) for file in logs if file.is_file()}
    mine = (i for i, log in enumerate(walks.logs) if log in hashes)
    return next(mine, None)
