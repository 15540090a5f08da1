# SPDX-License-Identifier: MIT
"""Files of a run while it is recorded: log, profiles, manifest, and disk space for its end."""

import contextlib
import hashlib
import io
import os
import shutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from model.file_lock import try_lock
from zebro_lab.files.errors import RecordingError
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.runs.folder import LOG_FILE, epoch_ns
from zebro_lab.runs.manifest import (
    MANIFEST_FILE,
    RunManifest,
    manifest_text,
    profile_file,
    write_manifest,
)
from zebro_lab.runs.profile_streams import stored_streams


class HashedFile(io.BufferedWriter):
    """New output file that computes its SHA-256 while it is written, from beginning to end.

    Args:
        path: Path of the file, which must not exist.

    Attributes:
        sha256: Hash of all that was written.
        flushed: Number of bytes that the system has taken.

    Raises:
        OSError: The file cannot be created.
    """

    def __init__(self, path: Path) -> None:
        # Always at the end: what another program cuts off is missing in the size, not a hole.
        path.touch(exist_ok=False)
        super().__init__(path.open("ab", buffering=0))
        self.sha256 = hashlib.sha256()
        self._written = self.flushed = 0

    def write(self, data: Any) -> int:
        """Write bytes at the end, and return their number; `OSError` if the disk fails."""
        self.sha256.update(data)
        self._written += len(data)
        return super().write(data)

    def flush(self) -> None:
        """Hand all bytes to the system; `OSError` if the disk fails."""
        super().flush()
        self.flushed = self._written


class OpenPlace:
    """Check of whether an open file is still under its path, by device and inode, and whole.

    Args:
        path: Path of the file.
        file: The file, open.

    Raises:
        OSError: The file or its folder cannot be examined.
    """

    def __init__(self, path: Path, file: HashedFile) -> None:
        self._path = path
        self._open = file
        self._number = file.fileno()
        self._file = identity(os.fstat(self._number))
        self._folder = identity(path.parent.stat())

    def problem(self) -> str | None:
        """Return why the open file is not whole or not under its path; None where it is."""
        written = self._open.flushed
        try:
            found = self._path.stat()
        except FileNotFoundError:
            return f"{self._path} no longer exists: the file or its folder was removed or renamed"
        except OSError as error:
            return f"{self._path} can no longer be accessed: {error.strerror}"
        if identity(found) != self._file:
            return f"{self._path} was removed or renamed, and another file has its name now"
        if found.st_size < written:
            return f"{self._path} was cut to {found.st_size} of the {written} bytes written"
        return None

    def folder(self) -> Path | None:
        """Return the folder's present path, on Linux also after a rename; None if not found."""
        for place in (self._path.parent, *self._renamed()):
            try:
                if identity(place.stat()) == self._folder:
                    return place
            except OSError:
                continue
        return None

    def _renamed(self) -> list[Path]:
        """Return the present folder of the open file by `/proc` in a list; empty if unknown."""
        try:
            return [Path(f"/proc/self/fd/{self._number}").readlink().parent]
        except OSError:
            return []


@contextmanager
def needing_threads() -> Iterator[None]:
    """Convert a failure to start a thread in the `with` statement to a `RecordingError`.

    Raises:
        RecordingError: A thread could not be started. Other exceptions pass unchanged.
    """
    try:
        yield
    except RuntimeError as error:
        if "start new thread" not in str(error):
            raise
        raise RecordingError(
            f"{error}: the system allows no more threads; close other programs, or raise the "
            "limit of threads (ulimit -u)"
        ) from error


def require_space(folder: Path, least: float) -> None:
    """Raise where the disk of a folder has too little free space.

    Args:
        folder: The folder, which exists.
        least: Least free space [bytes].

    Raises:
        RecordingError: Less space is free, or the free space cannot be determined.
    """
    try:
        free = shutil.disk_usage(folder).free
    except OSError as error:
        raise RecordingError(f"{folder}: cannot determine free space: {error.strerror}") from error
    if free < least:
        raise RecordingError(
            f"the disk of {folder} has {free / 1e6:.0f} MB free; expected at least "
            f"{least / 1e6:.0f} MB: delete files, or choose a folder on another disk with --data"
        )


def sync_files(paths: Iterable[Path]) -> None:
    """Flush existing files to the disk (fsync), after all could be opened.

    Raises:
        OSError: The disk fails, or a file is missing or not writable.
    """
    with ExitStack() as stack:
        for file in [stack.enter_context(path.open("r+b")) for path in paths]:
            os.fsync(file.fileno())


def identity(status: os.stat_result) -> tuple[int, int]:
    """Return device and inode number, which identify a file or folder."""
    return status.st_dev, status.st_ino


RESERVE: Final = 1 << 16
"""Disk space reserved in the run folder for log end and end record on a full disk [bytes]."""
_RESERVE_FILE = ".reserve"


class RunFiles:
    """Open files of a run folder; the constructor writes profiles, manifest and start of the log.

    It also reserves disk space for the end in a hidden file of `RESERVE` bytes.

    Args:
        folder: The run folder, empty.
        manifest: Manifest of the run that begins.
        profiles: TOML text of each profile, by its name in the run folder.
        start: Host time at which the run began [s].

    Attributes:
        folder: The run folder; its new path if it was renamed before its end was written.
        log: Writer of the log, open.
        streams: Names of the streams that the profiles describe.

    Raises:
        OSError: A file cannot be written.
        RigError: A profile is invalid.
    """

    def __init__(
        self,
        folder: Path,
        manifest: RunManifest,
        *,
        profiles: Mapping[str, str],
        start: float,
    ) -> None:
        self.folder = folder
        for name, text in profiles.items():
            profile_file(folder, name).parent.mkdir(exist_ok=True)
            profile_file(folder, name).write_text(text, encoding="utf-8", newline="")
        self._first = [folder / MANIFEST_FILE, *(profile_file(folder, name) for name in profiles)]
        streams = stored_streams(folder, profiles)
        self.streams = tuple(streams)
        (folder / _RESERVE_FILE).write_bytes(os.urandom(RESERVE))
        self._file = HashedFile(folder / LOG_FILE)
        try:
            try_lock(self._file.fileno())  # until it is closed, the run is being recorded
            self._place = OpenPlace(folder / LOG_FILE, self._file)
            self.log = LogWriter(
                self._file, streams=streams, start=start,
                attachments={f"profiles/{name}.toml": text for name, text in profiles.items()},
                start_ns=epoch_ns(manifest.began),
            )  # fmt: skip
            self.log.event(start, f"recording '{manifest.label}' began, source {manifest.source}")
            self.log.flush()
            draft = folder / f".{MANIFEST_FILE}.part"
            draft.write_text(manifest_text(manifest), encoding="utf-8", newline="")
            draft.replace(folder / MANIFEST_FILE)
        except BaseException:
            self._file.close()
            raise

    def sync_first(self) -> None:
        """Flush manifest and profiles to the disk (fsync); OSError if one is missing."""
        sync_files(self._first)

    def sync_log(self) -> None:
        """Flush the written log to the disk (fsync)."""
        os.fsync(self._file.fileno())

    def require_place(self) -> None:
        """Check that the log is whole and still under its path.

        Raises:
            RecordingError: The log was cut, or it or its folder removed, renamed or replaced.
        """
        problem = self._place.problem()
        if problem is not None:
            raise RecordingError(f"{problem}, while the run was being recorded")

    def free_reserve(self) -> None:
        """Delete the reserve file, so that its disk space is free for the end of the run."""
        (self.folder / _RESERVE_FILE).unlink(missing_ok=True)

    def finish_log(self) -> None:
        """Write index and end of the log and flush the log to the disk (fsync)."""
        self.log.finish()
        self._file.flush()
        self.sync_log()

    def write_end(self, manifest: RunManifest, *, whole: bool) -> None:
        """Write the end record with sample counts and checksum, also into a renamed folder.

        Args:
            manifest: Manifest of the run that ended; `streams` and `log_sha256` are set here.
            whole: Whether the log is complete; else its SHA-256 is None.

        Raises:
            RecordingError: The folder is gone.
            OSError: The end record cannot be written.
        """
        folder = self._place.folder()
        if folder is None:
            raise RecordingError(
                f"{self.folder} was removed or moved during the recording, so that its run.json "
                "cannot be completed. If it was moved, move it back; else record again"
            )
        self.folder = folder
        log_sha256 = self._file.sha256.hexdigest() if whole else None
        write_manifest(folder, replace(manifest, streams=self.log.written, log_sha256=log_sha256))

    def close(self) -> None:
        """Close the log's file; an OSError is suppressed."""
        with contextlib.suppress(OSError):
            self._file.close()
