# SPDX-License-Identifier: MIT
"""Match an estimated trajectory with a reference and compute its errors."""

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from model.counted import counted
from model.metrics.matching import match_times
from model.metrics.rigid_errors import RigidErrors, rigid_errors, round_distances
from model.poses import Poses
from model.rigid_path import RigidPath
from zebro_lab.files.errors import DataError
from zebro_lab.files.names import shortest_distinct
from zebro_lab.track.trajectory.file import Trajectory
from zebro_lab.validation.extents import unit_warning

_NEAR: Final = 0.05
"""Largest relative difference of a ratio of extents from the factor between two units [-]."""
FEWEST = 3  # two motions, so that an alignment leaves an error


class Errors(NamedTuple):
    """Errors of an estimate in one space.

    Attributes:
        where: "plane xy" (or other axes) or "space".
        errors: The errors.
        estimate: Estimated poses, scaled if that was asked for.
        reference: Reference poses at the same times.
    """

    where: str
    errors: RigidErrors
    estimate: RigidPath
    reference: RigidPath


@dataclass(frozen=True)
class JudgedPair:
    """Errors of an estimated trajectory against a reference.

    Attributes:
        reference: The reference as read.
        estimate: The estimate as read.
        rows: Errors in the plane; then in space, where both files have z.
        tracked: Matched reference poses in the plane.
        estimated: Matched estimated poses in the plane at the reference's times, scaled if that was
            asked for.
        notes: Notes, one line each.
    """

    reference: Trajectory
    estimate: Trajectory
    rows: tuple[Errors, ...]
    tracked: Poses
    estimated: Poses
    notes: tuple[str, ...]

    @property
    def title(self) -> str:
        """Names of both files, with as few parts of their paths as distinguish them."""
        files = [each.file.absolute() for each in (self.estimate, self.reference)]
        if files[0] == files[1]:
            return f"{files[0].name} against itself"
        return " against ".join(shortest_distinct(files))

    @property
    def source(self) -> str:
        """Sources of both, joined by commas."""
        return ", ".join(sorted({self.reference.source, self.estimate.source}))


def judge_pair(
    reference: Trajectory,
    estimate: Trajectory,
    *,
    max_difference: float,
    time_offset: float = 0.0,
    distances: tuple[float, ...] = (),
    correct_scale: bool = False,
) -> JudgedPair:
    """Match poses by time, or by number without times, and compute errors in plane and space.

    Args:
        reference: The reference.
        estimate: The estimate.
        max_difference: Largest difference of the times of a matched pair [s].
        time_offset: Time added to the reference's times [s].
        distances: Distances of relative errors [m]; if empty, round distances are chosen by the
            length of the reference.
        correct_scale: Whether the estimate is first multiplied by the scale that fits best, in the
            plane and in space each.

    Raises:
        DataError: Only one has times, both have none and not equally many poses, or fewer than
            `FEWEST` poses match.
    """
    seen, found, note = _matched(reference, estimate, max_difference, time_offset)
    tracked = seen.in_plane(reference.plane, forward=reference.forward)
    estimated = replace(found, t=seen.t).in_plane(estimate.plane, forward=estimate.forward)
    flat = RigidPath.of_poses(tracked)
    distances = distances or round_distances(float(flat.travelled[-1]))
    pairs = [(f"plane {reference.plane}", RigidPath.of_poses(estimated), flat)]
    if reference.in_space and estimate.in_space:
        pairs.append(("space", found, seen))
    rows = tuple(_errors(*pair, distances=distances, correct_scale=correct_scale) for pair in pairs)
    scaled = replace(estimated, position=rows[0].estimate.position)
    sizes = () if correct_scale else unit_warning(
        (seen.position, str(reference.file)), (found.position, str(estimate.file)), near=_NEAR
    )  # fmt: skip
    sizes = (f"{each}, or add --correct-scale" for each in sizes)
    notes = (*sizes, *reference.notes, *estimate.notes, note)
    return JudgedPair(reference, estimate, rows, tracked, scaled, notes)


def _errors(
    where: str,
    estimate: RigidPath,
    reference: RigidPath,
    *,
    distances: tuple[float, ...],
    correct_scale: bool,
) -> Errors:
    """Compute the errors in one space, and the estimate multiplied by the scale used for them."""
    errors = rigid_errors(estimate, reference, distances=distances, correct_scale=correct_scale)
    return Errors(where, errors, estimate.scaled(errors.scale), reference)


def _matched(
    reference: Trajectory, estimate: Trajectory, max_difference: float, time_offset: float
) -> tuple[RigidPath, RigidPath, str]:
    """Return the matched poses of the reference and of the estimate, and a note on the others.

    Raises:
        DataError: As in `judge_pair`.
    """
    if reference.timed != estimate.timed:
        without = estimate if reference.timed else reference
        raise DataError(
            "has no times, and the other file has; give the file of its times with --times",
            file=without.file,
        )
    a, b = reference.path, estimate.path
    if not reference.timed:
        if len(a) != len(b):
            raise DataError(
                f"has {counted(len(b), 'pose')} without times, the reference has {len(a)}; "
                "expected as many of both, or the file of their times with --times",
                file=estimate.file,
            )
        return a, b, "poses are matched by their number: the files have no times"
    a = replace(a, t=a.t + time_offset)
    chosen, found = match_times(a.t, b.t, most=max_difference)
    if len(chosen) < FEWEST:
        raise DataError(
            f"poses with a reference pose within {max_difference:g} s: {len(chosen)}; expected "
            f"{FEWEST} or more: the reference has times from {a.t[0]:.10g} to {a.t[-1]:.10g} s, "
            f"this file from {b.t[0]:.10g} to {b.t[-1]:.10g} s; try --max-difference, or "
            "--time-offset for another clock",
            file=estimate.file,
        )
    a, b = a.part(chosen), b.part(found)
    widest = float(np.abs(a.t - b.t).max())
    note = (
        f"{len(a)} of {len(reference.path)} reference and {len(estimate.path)} estimated poses are "
        f"matched, at most {widest:.3g} s apart"
    )
    return a, b, note
