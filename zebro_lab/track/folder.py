# SPDX-License-Identifier: MIT
"""Read and write a track folder: `track.csv`, `track.tum`, joint covariance, `manifest.json`."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pandas as pd

from model.arrays import Array
from zebro_lab.files.folder_manifest import read_folder_manifest
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import MANIFEST, ResultKind, result_folder
from zebro_lab.track.annotations import ANNOTATIONS_FILE
from zebro_lab.track.floor_file import FLOOR_FILE
from zebro_lab.track.joint_file import JOINT
from zebro_lab.track.request import KIND

SCHEMA = 1
TRACK_CSV = "track.csv"
TRACK_TUM = "track.tum"
PICTURES = in_every_format("overlay", "map", "residuals")
TRACKED = ResultKind(
    KIND, "track", (TRACK_CSV, TRACK_TUM, JOINT, FLOOR_FILE, ANNOTATIONS_FILE, *PICTURES), SCHEMA
)
"""Kind of folder that `track` writes; an earlier track's files are replaced."""

_DIGITS = "%.10g"


@contextmanager
def track_folder(
    out: Path,
    columns: Mapping[str, Sequence[float] | Sequence[str] | Array],
    *,
    tum: Sequence[str],
    source: str,
    settings: Mapping[str, object],
    inputs: Mapping[str, str],
    report: Mapping[str, object],
) -> Iterator[Path]:
    """Write a track folder atomically.

    The body of the `with` statement adds pictures and other files to the draft. The manifest, which
    lists all files, is written last.

    Args:
        out: Folder to create, or to replace if it is a track folder.
        columns: Known columns of `track.csv`, by names of `tracking.path.TRACK_COLUMNS`, in order.
        tum: Lines of `track.tum`.
        source: Source of the track: "real", "sim:what" or "unknown".
        settings: Options of the command, as JSON can hold them.
        inputs: SHA-256 of each file that was read, by path.
        report: Further manifest entries: left-out photographs, notes, origin of time.

    Yields:
        Path of the draft folder.

    Raises:
        AlreadyExists: `out` is a file or the result of another command, a file of the old result
            was changed, or a user's file has a name to be written; others are kept.
        NotWritten: The folder cannot be created or moved.
    """
    content = {"source": source, "settings": settings, **report, "inputs": inputs}
    with result_folder(out, TRACKED, content=content) as draft:
        table = pd.DataFrame(dict(columns))
        table.to_csv(draft / TRACK_CSV, index=False, float_format=_DIGITS, lineterminator="\n")
        (draft / TRACK_TUM).write_text("\n".join(tum) + "\n", encoding="utf-8")
        yield draft


def read_track_manifest(folder: Path) -> Mapping[str, Any]:
    """Read the manifest of a track folder.

    Raises:
        NotFound: The folder has no manifest.
        DataError: The manifest is damaged, of another schema, or of another command.
    """
    recover(folder)
    return read_folder_manifest(folder / MANIFEST, of="track", kinds=(KIND,), schema=SCHEMA)


def written(folder: Path) -> Sequence[Path]:
    """List the existing files of a track folder that have names which `track` writes."""
    return [folder / name for name in (*TRACKED.names, MANIFEST) if (folder / name).is_file()]
