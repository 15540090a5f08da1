# SPDX-License-Identifier: MIT
"""Run folders: `DATA/<utc time>_<kind>_<label>/` with `run.json` and `log.mcap`.

Only this module depends on the layout of run folders, which docs/formats.md describes.
"""

import re
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

import numpy as np

from model.file_lock import is_locked
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound, RecordingError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.raw_log import raw_topic, read_raw_log
from zebro_lab.runs.manifest import (
    MANIFEST_FILE,
    RECORDING,
    RIG_KIND,
    RunManifest,
    read_manifest,
)
from zebro_lab.runs.slip_rig_decoding import derive_table
from zebro_lab.runs.slip_rig_table import SlipRigTable

LOG_FILE = "log.mcap"
RECOVERED: Final = "recovered"
"""State of a run whose recorder was killed: its samples end where the log ends."""
_BOARD_TOPIC: Final = raw_topic("board")
STILL_GROWING: Final = 3.0
"""Where files cannot be locked, a log that changed less than this ago is being recorded [s]."""


@dataclass(frozen=True)
class SlipRigRun:
    """A run of the slip rig, read from its folder.

    Attributes:
        folder: Run folder.
        manifest: Content of `run.json`.
        table: Samples in SI; the manifest's zero offsets, if any, are subtracted from forces.
        files: Manifest and log, without the profile that decoded the log's counts.
        notes: Notes on damage and dropped samples, one line each.
    """

    folder: Path
    manifest: RunManifest
    table: SlipRigTable
    files: tuple[Path, ...]
    notes: tuple[str, ...] = field(default=())


def require_new(folder: Path) -> None:
    """Raise AlreadyExists where the path of a new run folder exists."""
    if folder.exists():
        raise AlreadyExists(f"{folder} exists already; choose another name with --label")


def require_profiles(folder: Path, manifest: RunManifest) -> None:
    """Raise DataError where a run with a log is of an early version, which stored no profiles."""
    if not manifest.profiles:
        raise DataError(
            "is of an earlier version without profiles; export it with that version",
            file=folder / MANIFEST_FILE,
        )


def read_slip_rig_run(folder: Path) -> SlipRigRun:
    """Read the samples of a slip-rig run; of a damaged log without the damage, with a note.

    Raises:
        NotFound: The manifest or the log is missing.
        DataError: Manifest, log or the rig's profile is invalid, or the profile is missing; or the
            run has another kind, no positive radius, no samples of a stream, or an undamaged log
            with another checksum.
    """
    manifest = read_manifest(folder)
    if manifest.kind != RIG_KIND:
        raise DataError(
            f"is a run of kind '{manifest.kind}', expected '{RIG_KIND}'; do not give this run",
            file=folder / MANIFEST_FILE,
        )
    require_profiles(folder, manifest)
    path = folder / LOG_FILE
    if not path.is_file():
        raise NotFound(f"{path}: missing; copy it from the computer where the run was recorded")
    raw = read_raw_log(path)
    table, notes = derive_table(folder, raw.streams, zero=manifest.constants)
    _require_constants(manifest, folder / MANIFEST_FILE)
    if raw.damage is not None:
        notes = (_salvage_note(folder, manifest, len(table), raw.damage), *notes)
    else:
        require_recorded(path, manifest)
    return SlipRigRun(folder, manifest, table, (folder / MANIFEST_FILE, path), notes)


def new_run_folder(data_dir: Path, *, kind: str, label: str, start: datetime) -> Path:
    """Create the empty folder of a run to be recorded, and return its path.

    Args:
        data_dir: Folder of run folders; created when missing.
        kind: Kind of the run, one of `KINDS`.
        label: Label of the run.
        start: Start of the run, with its time zone.

    Raises:
        AlreadyExists: A run of this kind, start (to the second) and label exists.
        RecordingError: The folder cannot be created.
    """
    folder = run_path(data_dir, kind, label, start)
    try:
        folder.mkdir(parents=True)
    except FileExistsError as error:
        if folder.is_dir():
            require_new(folder)
        raise RecordingError(
            f"{error.filename} exists and is not a folder; choose another folder with --data"
        ) from error
    except OSError as error:
        raise RecordingError(
            f"cannot write to {data_dir}: {error.strerror}; choose another folder with --data"
        ) from error
    return folder


@contextmanager
def removing_new_folders(folder: Path) -> Iterator[None]:
    """Remove a folder, and those it lies in, if the body fails; not those that exist before.

    A folder that is not empty stays, whoever has written into it.

    Args:
        folder: Folder that the body creates where it is missing.
    """
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        yield
    except BaseException:
        for each in missing:
            with suppress(OSError):  # it is not empty, or was not created
                each.rmdir()
        raise


def find_runs(data_dir: Path) -> list[Path]:
    """Find all folders with a `run.json`: `data_dir` and any below it, sorted by path.

    Raises:
        NotFound: The folder does not exist.
    """
    if not data_dir.is_dir():
        found = "is a file" if data_dir.exists() else "no such folder"
        raise NotFound(f"{data_dir}: {found}; give the folder that holds the run folders")
    return sorted(file.parent for file in data_dir.rglob(MANIFEST_FILE))


def run_state(folder: Path, manifest: RunManifest) -> str:
    """Return the state of a run: its exit status, `recording` or `recovered`.

    A run whose manifest still says `recording` is `recovered` if its log is missing or no program
    has it locked, as a recorder has until its end: the recorder died.

    Args:
        folder: Run folder.
        manifest: Manifest of the run.
    """
    if manifest.exit_status != RECORDING:
        return manifest.exit_status
    log = folder / LOG_FILE
    if not log.is_file():
        return RECOVERED
    with log.open("rb") as file:
        locked = is_locked(file.fileno())
    if locked is None:
        locked = time.time() - log.stat().st_mtime < STILL_GROWING
    return RECORDING if locked else RECOVERED


def require_ended(folder: Path) -> None:
    """Raise where a run is being recorded: the recorder rewrites the manifest at the run's end.

    Raises:
        NotFound: The folder is not a run folder.
        DataError: The manifest is invalid, see `read_manifest`.
        RecordingError: The run is being recorded, by `run_state`.
    """
    if run_state(folder, read_manifest(folder)) == RECORDING:
        raise RecordingError(f"{folder} is being recorded; end the recording first")


def _require_constants(manifest: RunManifest, file: Path) -> None:
    """Raise `DataError` if a zero offset is not finite, or a radius missing or not positive.

    A zero offset that is missing counts as 0.
    """
    for name in ("zero_normal", "zero_traction"):
        if not np.isfinite(manifest.constants.get(name, 0.0)):
            raise DataError(f"is unknown; enter the zero in N (constants.{name})", file=file,
                            column=name)  # fmt: skip
    for name in ("radius_leg", "radius_ground"):
        radius = manifest.constants.get(name, np.nan)
        if not (np.isfinite(radius) and radius > 0):
            raise DataError(
                f"is {radius:g} m, expected more than 0 and finite (constants.{name})", file=file,
                column=name, value=radius, unit="m",
            )  # fmt: skip


def require_recorded(path: Path, manifest: RunManifest) -> None:
    """Check a log file against the SHA-256 in the manifest.

    Args:
        path: Log file.
        manifest: Manifest of the run; nothing is checked if its `log_sha256` is None.

    Raises:
        DataError: The SHA-256 checksums differ.
    """
    if manifest.log_sha256 is not None and file_hash(path) != manifest.log_sha256:
        raise DataError(
            f"was changed after the recording: its SHA-256 differs from that in {MANIFEST_FILE}; "
            "restore it, or, for calibrations, exclude the run: zebro-lab exclude RUN --why REASON",
            file=path,
        )


def _salvage_note(folder: Path, manifest: RunManifest, count: int, damage: str) -> str:
    """Return a note on a damaged log: how many samples were read, and of how many if known."""
    recorded = manifest.streams.get(_BOARD_TOPIC)
    of_all = f" of {recorded}" if recorded else ""
    return f"{folder.name}: {LOG_FILE} is incomplete ({damage}); {count}{of_all} samples were read"


def run_path(data_dir: Path, kind: str, label: str, start: datetime) -> Path:
    """Return the path of a run folder: `data_dir/<utc time>_<kind>_<label>`.

    Args:
        data_dir: Folder of run folders.
        kind: Kind of the run.
        label: Label of the run; characters unfit for a file name become hyphens, and "run" stands
            for a label with no others.
        start: Start of the run; converted to UTC, to the second.
    """
    return Path(data_dir) / f"{start.astimezone(UTC):%Y%m%dT%H%M%SZ}_{kind}_{_slug(label)}"


def _slug(label: str) -> str:
    """Return a label for a file name: what is no letter, digit, "_", "." or "-" becomes "-"."""
    return re.sub(r"[^\w.-]+", "-", label).strip("-.") or "run"


def epoch_ns(moment: datetime) -> int:
    """Convert a moment with a time zone to nanoseconds since the Unix epoch, to the microsecond."""
    return (moment - datetime(1970, 1, 1, tzinfo=UTC)) // timedelta(microseconds=1) * 1000
