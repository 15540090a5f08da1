# SPDX-License-Identifier: MIT
"""What walks said, for the walk at hand: the same robot's legs, or another's on the same floor."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.bayes.walks.posterior import WalkPosterior
from model.predict import LegState
from zebro_lab.calibration.walks_folder import StoredWalks, describe_legs
from zebro_lab.files.provenance import file_hash
from zebro_lab.robot.robot_file import RobotFile

_SEED = 1  # of another robot's legs, which are drawn from the prior


@dataclass(frozen=True)
class InformedLegs:
    """What is believed of the legs and the floor of a walk.

    Attributes:
        posterior: What walks said.
        index: The walk's own index among them; None for a walk to come.
        folder: Where it was read from.
        notes: For a person, one line each.
    """

    posterior: WalkPosterior
    index: int | None
    folder: Path
    notes: tuple[str, ...]

    @property
    def middle(self) -> LegState:
        """The one likeliest state of the legs."""
        return self.posterior.most_likely(walk=self.index)

    def draw(self, n: int, *, rng: np.random.Generator) -> LegState:
        """Draw leg states from the posterior.

        Args:
            n: Number of draws.
            rng: Random number generator.
        """
        return self.posterior.draw(n, rng=rng, walk=self.index)

    def settings(self) -> dict[str, object]:
        """Return what decided the numbers, as JSON can hold it."""
        legs = self.middle
        return {
            "folder": str(self.folder),
            "walks": list(self.posterior.walks),
            "this_walk": None if self.index is None else self.posterior.walks[self.index],
            "leg_offset": legs.offset[0].tolist(),
            "leg_arc_beyond": float(legs.arc[0]),
            "grip": float(legs.grip[0]),
            "slip_stiffness": float(legs.stiffness[0]),
            "fall": float(legs.fall[0]),
            "steering": float(legs.steering[0]),
            "stride": float(legs.stride[0]),
        }


def informed_legs(
    walks: StoredWalks,
    described: RobotFile,
    *,
    logs: Sequence[Path] = (),
    same_legs: bool | None = None,
) -> InformedLegs:
    """Choose what of a posterior holds for a walk.

    Args:
        walks: The posterior after walks.
        described: The robot that walks.
        logs: Files of its leg log.
        same_legs: Whether the legs are those that were fitted; told by the description when None.
    """
    same = walks.legs == describe_legs(described) if same_legs is None else same_legs
    names = ", ".join(walks.posterior.walks)
    if not same:
        floor = walks.posterior.of_floor_alone(rng=np.random.default_rng(_SEED))
        note = f"walks: {names} inform the floor alone; their legs were another robot's"
        return InformedLegs(floor, None, walks.folder, (note,))
    index = _index(walks, logs)
    notes = [f"walks: legs and floor as {names} have them"]
    if index is not None:
        notes.append(
            f"walks: {walks.posterior.walks[index]} is this walk: its own track informed the "
            "prediction, which the track can confirm but not test"
        )
    return InformedLegs(walks.posterior, index, walks.folder, tuple(notes))


def _index(walks: StoredWalks, logs: Sequence[Path]) -> int | None:
    hashes = {file_hash(file) for file in logs if file.is_file()}
    mine = (i for i, log in enumerate(walks.logs) if log in hashes)
    return next(mine, None)
