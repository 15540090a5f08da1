# SPDX-License-Identifier: MIT
"""Read and append to `experiment.jsonl`, the journal of an experiment with one event per line.

The journal is a record for people. The end records of the run folders decide which points are
finished (`zebro_lab.experiment.points`). An emergency stop is also latched by a separate file
(`zebro_lab.experiment.latch`).
"""

import contextlib
import errno
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from zebro_lab.experiment.latch import LATCH_FILE, EmergencyLatch
from zebro_lab.files.errors import AlreadyExists, DataError, RecordingError, SettingsError
from zebro_lab.files.opening import read_bytes
from zebro_lab.files.provenance import fingerprint

JOURNAL_FILE: Final = "experiment.jsonl"
RESERVE_FILE: Final = ".experiment.reserve"
RESERVE: Final = 1 << 16
"""Reserved space that is freed when the disk is full, for the end of a run [bytes]."""
LARGEST: Final = 256 << 20
"""Largest size of a journal [bytes]."""
EMERGENCY: Final = "emergency stop"
"""Prefix of the reason of an emergency stop."""


@dataclass(frozen=True)
class Journal:
    """Content of a journal.

    Attributes:
        plan: Fingerprint of the plan.
        accepted: Number of the accepted point, by name of its run folder.
        folders: Names of the run folders that were closed, their point accepted or not.
        latched: Reason of the last emergency stop or damaged line since a reset; None without.
        points: Entries of the run folders that were closed, in order, as `ExperimentFolder` writes
            them.
    """

    plan: str
    accepted: Mapping[str, int]
    folders: frozenset[str]
    latched: str | None
    points: Sequence[Mapping[str, Any]]


def plan_fingerprint(text: str) -> str:
    """Compute a fingerprint (hash) of the text of a plan file."""
    return fingerprint({}, {"plan": text})


class JournalWriter:
    """Writer of `experiment.jsonl`; each event is flushed to the disk (fsync) when appended.

    As a context manager it keeps a reserve file, which is deleted when the disk is full, and
    writes no more once another program has changed the journal.

    Args:
        data: Folder of the experiment; created when missing.
    """

    def __init__(self, data: Path) -> None:
        data.mkdir(parents=True, exist_ok=True)
        self._file = data / JOURNAL_FILE
        self._reserve = data / RESERVE_FILE
        self._expected: int | None = None

    def __enter__(self) -> "JournalWriter":
        self._expected = self._size()
        with contextlib.suppress(OSError):  # on a full disk `require_room` stops the run
            self._reserve.unlink(missing_ok=True)  # whatever is there: it is not written through
            with self._reserve.open("xb") as file:
                file.write(os.urandom(RESERVE))
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):
            self._reserve.unlink(missing_ok=True)

    def append(self, kind: str, text: str, **more: Any) -> None:
        """Append an event as one JSON line with UTC time; on a full disk the reserve is freed.

        Args:
            kind: Kind of event, such as `point` or `end`.
            text: Description of the event.
            more: Further entries of the line; values that JSON can hold.

        Raises:
            OSError: The line could not be written or flushed, and the journal is unchanged.
            RecordingError: Another program has changed the journal.
        """
        found = self._size()
        if self._expected not in (None, found):
            raise RecordingError(
                f"{self._file} was changed by another program during the experiment: it has "
                f"{found} bytes and {self._expected} were written; put it back before --resume"
            )
        entry = {"time": datetime.now(UTC).isoformat(), "kind": kind, "text": text, **more}
        # ASCII escapes: no character of a text can end a line or fail to be encoded.
        line = json.dumps(entry).encode("ascii") + b"\n"
        try:
            self._write(line)
        except OSError as error:
            if error.errno not in (errno.ENOSPC, errno.EDQUOT):
                raise
            self._reserve.unlink(missing_ok=True)
            self._write(line)
        if self._expected is not None:
            self._expected += len(line)

    def _size(self) -> int:
        """Return the size of the journal [bytes], 0 without one."""
        return self._file.stat().st_size if self._file.exists() else 0

    def repair(self) -> None:
        """Remove a last line without a newline (a crash), and append its text as an event.

        The event is of kind `cut short`; nothing happens without such a line.
        """
        content = read_bytes(self._file, most=LARGEST)
        whole, _, cut = content.rpartition(b"\n")
        if not cut:
            return
        with self._file.open("r+b") as file:
            file.truncate(len(whole) + (1 if whole else 0))
        self.append("cut short", cut.decode("utf-8", "backslashreplace"))

    def _write(self, line: bytes) -> None:
        """Append a line and flush it to the disk (fsync); one for which that fails is removed."""
        handle = os.open(self._file, os.O_WRONLY | os.O_CREAT, 0o644)
        try:
            before = os.lseek(handle, 0, os.SEEK_END)
            try:
                _write_all(handle, line)
                os.fsync(handle)
            except OSError:
                os.ftruncate(handle, before)
                if not before:  # an empty file would be neither a new experiment nor an old one
                    self._file.unlink()
                raise
        finally:
            with contextlib.suppress(OSError):  # the line is on the disk, or known to have failed
                os.close(handle)


def _write_all(handle: int, data: bytes) -> None:
    """Write all bytes to a file descriptor, where one call may write a part only."""
    while data:
        data = data[os.write(handle, data) :]


def read_journal(data: Path) -> Journal:
    """Read the journal of an experiment's folder; a last line truncated by a crash is ignored.

    Any other invalid line may have held an emergency stop, and counts as one.

    Raises:
        NotFound: The folder has no journal.
        DataError: The journal cannot be read, or has no fingerprint of a plan.
    """
    file = data / JOURNAL_FILE
    entries = list(_entries(file))
    plan = next((e.get("fingerprint") for e in entries if e.get("kind") == "plan"), None)
    if not isinstance(plan, str):
        raise DataError("has no entry for the plan; choose another folder with --data", file=file)
    points = [entry for entry in entries if entry.get("kind") == "point"]
    latched = None
    for entry in entries:
        if entry.get("kind") == "reset":
            latched = None
        elif entry.get("kind") == "damaged" or (
            entry.get("kind") == "end" and str(entry.get("text")).startswith(EMERGENCY)
        ):
            latched = str(entry.get("text"))
    return Journal(
        plan=plan,
        accepted={
            str(entry.get("folder")): entry["number"] for entry in points
            if entry.get("accepted") is True and type(entry.get("number")) is int
        },
        folders=frozenset(str(entry.get("folder")) for entry in points),
        latched=latched,
        points=points,
    )  # fmt: skip


def begin_or_resume(data: Path, plan_text: str, *, resume: bool, reset: bool) -> Journal:
    """Start the journal of a new experiment, or resume an existing one; prepare the latch file.

    Args:
        data: Folder of the experiment; the caller holds its lock.
        plan_text: Text of the plan.
        resume: Whether to resume the experiment in the folder.
        reset: Whether to reset a latched emergency stop.

    Returns:
        Content of the journal after any repair and reset.

    Raises:
        NotFound, DataError: `resume` is set, and there is no readable journal.
        AlreadyExists: The folder has a journal, and `resume` is not set.
        SettingsError: The journal is of another plan, or an emergency stop is latched and `reset`
            is not set; or one of these files is a link.
        RecordingError: The latch file cannot be created or opened.
        OSError: The journal or the latch file cannot be written.
    """
    for file in (data / JOURNAL_FILE, data / LATCH_FILE):
        if file.is_symlink() or (file.is_file() and file.stat().st_nlink > 1):
            what = "is a link: a file elsewhere would change with it; put a copy in its place"
            raise SettingsError(what, file=file)
    writer, latch = JournalWriter(data), EmergencyLatch(data)
    journal = _resumed(data, plan_text) if resume else None
    if journal is None and os.path.lexists(data / JOURNAL_FILE):
        raise AlreadyExists(
            f"{data} holds an experiment; add --resume to continue it, or choose another --data"
        )
    latched = latch.reason or (journal.latched if journal else None)
    if latched is not None and not reset:
        raise SettingsError(
            f"an emergency stop is latched ({latched}); inspect the rig, add --reset-emergency",
            file=data / (JOURNAL_FILE if journal else LATCH_FILE),
        )
    try:
        latch.prepare()
    except OSError as error:
        raise RecordingError(
            f"{data / LATCH_FILE}: cannot be opened for writing ({error.strerror}), so that an "
            "emergency stop could not be latched; move it away, or choose another --data folder"
        ) from error
    if journal is None:
        writer.append("plan", plan_text, fingerprint=plan_fingerprint(plan_text))
    else:
        writer.repair()
    if latched is not None:
        writer.append("reset", latched)
        latch.reset()
    return read_journal(data)


def _resumed(data: Path, plan_text: str) -> Journal:
    """Read the journal as `read_journal`; SettingsError where it was started with another plan."""
    journal = read_journal(data)
    if journal.plan != plan_fingerprint(plan_text):
        raise SettingsError(
            "was started with another plan or another text of it, comments included; use the text "
            "in the first line of this file, or choose another folder with --data",
            file=data / JOURNAL_FILE,
        )
    return journal


def _entries(file: Path) -> Iterator[dict[str, Any]]:
    """Yield the entry of each complete line; an invalid line gives an entry of kind `damaged`."""
    advice = "there is no experiment to resume; run without --resume"
    content = read_bytes(file, most=LARGEST, advice=advice)
    for number, line in enumerate(content.split(b"\n")[:-1], start=1):
        entry = _entry(line)
        if entry is None:
            yield {
                "kind": "damaged",
                "text": f"line {number} of the journal is damaged and may have held a stop",
            }
        else:
            yield entry


def _entry(line: bytes) -> dict[str, Any] | None:
    """Parse a line as a JSON object; None if it is none."""
    try:
        entry = json.loads(line.decode("utf-8"))
    except (ValueError, RecursionError):
        return None
    return entry if isinstance(entry, dict) else None
