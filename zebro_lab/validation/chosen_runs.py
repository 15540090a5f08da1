# SPDX-License-Identifier: MIT
"""Choose the runs to judge among the paths named on a command line, such as by `data/*`."""

from collections.abc import Sequence
from pathlib import Path

from zebro_lab.files.errors import NotFound
from zebro_lab.files.names import TRACK
from zebro_lab.runs.manifest import RIG_KIND, read_manifest
from zebro_lab.runs.recorded_legs import is_recorded
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.walk.folder import PREDICTION

Pair = tuple[Path, Path]


def pairs_of_runs(paths: Sequence[Path]) -> tuple[list[Pair], tuple[str, ...]]:
    """Return the folders of prediction and track of each run, and what is left out of several.

    A single path must be a run with both. Of several, those that are none, and runs of the rig, are
    left out, each with a note.

    Args:
        paths: Paths, in order.

    Raises:
        NotFound: A path does not exist, the only path lacks prediction or track, or all do.
        DataError: The manifest of a run is invalid.
    """
    if len(paths) == 1:
        return [pairs_of_run(paths[0])], ()
    pairs, left_out = [], []
    for path in paths:
        if (reason := _why_none(path)) is None:
            try:
                pairs.append(pairs_of_run(path))
                continue
            except NotFound as error:
                reason = str(error)
        left_out.append(f"left out, {path.name}: {reason}")
    if paths and not pairs:
        raise NotFound(
            f"none of {len(paths)} paths is a run with prediction and track; {'; '.join(left_out)}"
        )
    return pairs, tuple(left_out)


def _why_none(path: Path) -> str | None:
    """Return why a path is certainly no tracked walk; None if it may be one."""
    if not path.exists():
        raise NotFound(f"{path}: no such file or folder; name run folders")
    if not path.is_dir():
        return "a file, no run folder"
    if is_recorded(path):
        return "a run of the slip rig" if read_manifest(path).kind == RIG_KIND else None
    known = any((path / name).is_dir() for name in (PREDICTION, TRACK))
    return None if known else "no run folder"
