# SPDX-License-Identifier: MIT
"""Write and read `track_covariance.npz`: covariance of all poses of a track with each other."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.joint_covariance import JointCovariance
from zebro_lab.files.arrays import read_arrays
from zebro_lab.files.errors import DataError
from zebro_lab.files.folder_manifest import changed_output, lost_output

JOINT = "track_covariance.npz"
_NAMES = ("t", "own", "following", "by_error", "errors")
_ROUNDED = 1e-6  # relative difference of a covariance by the digits of `track.csv` [-]
_AGAIN = "track the photographs again"


def write_joint(
    folder: Path, t: Array, joint: JointCovariance, causes: Mapping[str, slice]
) -> None:
    """Write the joint covariance of a track's poses into a track folder.

    Args:
        folder: Folder to write `track_covariance.npz` into.
        t: Times of the poses, shape (n,) [s].
        joint: Their joint covariance.
        causes: By cause of shared errors, its rows in `joint.errors`.
    """
    by_row = np.full(len(joint.errors), "", dtype=object)
    for cause, slot in causes.items():
        by_row[slot] = cause
    np.savez_compressed(
        folder / JOINT, t=t, own=joint.own, following=joint.following, by_error=joint.by_error,
        errors=joint.errors, causes=by_row.astype(np.str_),
    )  # fmt: skip


def read_joint(
    track_csv: Path, t: Array, covariance: Array
) -> tuple[JointCovariance, tuple[str, ...]]:
    """Read the joint covariance beside a `track.csv`, as far as the table has its poses.

    Args:
        track_csv: The table, with or without `track_covariance.npz` beside it.
        t: Times of its poses, shape (n,) [s].
        covariance: Its covariance of each pose, shape (n, 3, 3).

    Returns:
        The joint covariance, and warnings. Without the file, or with that of other poses, errors of
        different poses are taken as independent.

    Raises:
        DataError: The file cannot be read, or its parts do not belong together.
    """
    file = track_csv.parent / JOINT
    independent = JointCovariance.independent(covariance)
    if not file.is_file():
        return independent, tuple(
            f"WARNING: {each}; errors of different poses are taken as independent"
            for each in lost_output(file)
        )
    times, joint = _read(file)
    rows = np.searchsorted((times[1:] + times[:-1]) / 2, t)  # the nearest: `t` is rounded
    if not np.allclose(times[rows], t, rtol=1e-9, atol=1e-9):
        return independent, (_of_others(file, "has other times"),)
    part = joint if len(rows) == len(joint) else joint.part(rows)
    unit = np.sqrt(np.diagonal(part.marginal, axis1=1, axis2=2))
    apart = np.abs(covariance - part.marginal)
    if np.any(apart > _ROUNDED * unit[:, :, None] * unit[:, None, :]):
        return independent, (_of_others(file, "has other covariances"),)
    return part, tuple(f"WARNING: {each}" for each in changed_output(file))


def _of_others(file: Path, why: str) -> str:
    """Return the warning that the file belongs to other poses, so that it is not used."""
    return (
        f"WARNING: {file} {why} than track.csv; errors of different poses are taken as "
        f"independent: {_AGAIN}, or delete the file"
    )


def _read(file: Path) -> tuple[Array, JointCovariance]:
    """Return times and joint covariance; raise `DataError` if an array is invalid."""
    arrays = read_arrays(file, _NAMES, advice=_AGAIN)
    parts = {name: np.asarray(arrays[name], dtype=float) for name in _NAMES}
    t = parts.pop("t")
    bad = [name for name, values in {"t": t, **parts}.items() if not np.isfinite(values).all()]
    if bad or t.ndim != 1 or np.any(np.diff(t) <= 0):
        what = f"'{bad[0]}' has values that are no numbers" if bad else "times do not increase"
        raise DataError(f"{what}; {_AGAIN}", file=file)
    try:
        joint = JointCovariance(**parts)
    except DomainError as error:
        raise DataError(f"{error}; {_AGAIN}", file=file) from error
    if len(joint) != len(t):
        raise DataError(f"has {len(t)} times of {len(joint)} poses; {_AGAIN}", file=file)
    return t, joint
