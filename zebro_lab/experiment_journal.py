# SPDX-License-Identifier: MIT
"""`experiment.jsonl`: what an experiment did, a line an event, and from it what is left to do."""

import json
import os
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from zebro_lab.errors import AlreadyExists, DataError, NotFound, SettingsError
from zebro_lab.provenance import fingerprint

JOURNAL_FILE: Final = "experiment.jsonl"
EMERGENCY: Final = "emergency stop"
"""How the reason of an emergency stop begins."""


@dataclass(frozen=True)
class Journal:
    """What a journal says.

    Attributes:
        plan: Fingerprint of the plan.
        finished: Numbers of the points that were accepted.
        folders: Names of the run folders that were closed.
        latched: Reason of an emergency stop that nobody has reset; None where there is none.
    """

    plan: str
    finished: frozenset[int]
    folders: frozenset[str]
    latched: str | None


def plan_fingerprint(text: str) -> str:
    """Compute a fingerprint of a plan's text."""
    return fingerprint({}, {"plan": text})


class JournalWriter:
    """Appends events; each is on the disk before the next is taken.

    Args:
        data: Folder of the experiment; made when missing.
    """

    def __init__(self, data: Path) -> None:
        data.mkdir(parents=True, exist_ok=True)
        self._file = data / JOURNAL_FILE

    def append(self, kind: str, text: str, **more: Any) -> None:
        """Append an event.

        Args:
            kind: What kind of event.
            text: What happened.
            more: Further entries of the line.
        """
        entry = {"time": datetime.now(UTC).isoformat(), "kind": kind, "text": text, **more}
        # A line that a crash cut short must not swallow this one.
        whole = not self._file.exists() or self._file.read_bytes()[-1:] in (b"", b"\n")
        with self._file.open("a", encoding="utf-8") as file:
            file.write(("" if whole else "\n") + json.dumps(entry, ensure_ascii=False) + "\n")
            file.flush()
            os.fsync(file.fileno())


def read_journal(data: Path) -> Journal:
    """Read a journal; a line that a crash cut short is passed over.

    Raises:
        NotFound: There is none.
        DataError: It does not begin with a plan.
    """
    file = data / JOURNAL_FILE
    if not file.is_file():
        raise NotFound(f"{file}: no experiment to resume; run without --resume")
    entries = [entry for line in file.read_text(encoding="utf-8").splitlines()
               if (entry := _entry(line)) is not None]  # fmt: skip
    plan = next((e["fingerprint"] for e in entries if e.get("kind") == "plan"), None)
    if not isinstance(plan, str):
        raise DataError("does not say which plan it is of; name another --data", file=file)
    points = [entry for entry in entries if entry.get("kind") == "point"]
    latched = None
    for entry in entries:
        if entry.get("kind") == "reset":
            latched = None
        elif entry.get("kind") == "end" and str(entry.get("text")).startswith(EMERGENCY):
            latched = str(entry["text"])
    return Journal(
        plan=plan,
        finished=frozenset(int(entry["number"]) for entry in points if entry.get("accepted")),
        folders=frozenset(str(entry.get("folder")) for entry in points),
        latched=latched,
    )


def begin_or_resume(data: Path, plan_text: str, *, resume: bool, reset: bool) -> frozenset[int]:
    """Begin a journal, or go on with one.

    Args:
        data: Folder of the experiment.
        plan_text: Text of the plan.
        resume: Go on with what is there.
        reset: Reset an emergency stop that is latched.

    Returns:
        Numbers of the points that are finished.

    Raises:
        AlreadyExists: There is an experiment, and it is not to be gone on with.
        SettingsError: It is of another plan, or an emergency stop is latched.
    """
    if not resume:
        if (data / JOURNAL_FILE).exists():
            raise AlreadyExists(
                f"{data} holds an experiment already; go on with it by --resume, or name another "
                "--data"
            )
        JournalWriter(data).append("plan", plan_text, fingerprint=plan_fingerprint(plan_text))
        return frozenset()
    journal = read_journal(data)
    if journal.plan != plan_fingerprint(plan_text):
        raise SettingsError(
            "is not the plan that was begun here; give that one, or another --data",
            file=data / JOURNAL_FILE,
        )
    if journal.latched is not None and not reset:
        raise SettingsError(
            f"{journal.latched} is latched; look after the rig, then go on with --reset-emergency",
            file=data / JOURNAL_FILE,
        )
    if journal.latched is not None:
        JournalWriter(data).append("reset", journal.latched)
    return journal.finished


def _entry(line: str) -> dict[str, Any] | None:
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) else None
