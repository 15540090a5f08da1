# SPDX-License-Identifier: MIT
"""Exclude a run from calibrations, or undo an exclusion; the manifest keeps every reason."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from zebro_lab.files.errors import DataError
from zebro_lab.runs.folder import require_ended
from zebro_lab.runs.manifest import RunManifest, read_manifest, write_manifest

EXCLUDED: Final = "excluded"
UNDONE: Final = "undone"
NO_REASON: Final = "no reason given"


def exclude_run(folder: Path, *, why: str) -> RunManifest:
    """Exclude a run from every later calibration in its manifest, and return that; data are kept.

    Args:
        folder: The run folder.
        why: Reason; earlier reasons are kept in `exclusions` of the manifest.

    Raises:
        NotFound: The folder is not a run folder.
        DataError: The manifest is invalid, or the reason is blank.
        RecordingError: The run is being recorded.
        OSError: The manifest cannot be written.
    """
    if not why.strip():
        raise DataError("the reason is blank; state why the run is excluded", file=folder)
    return _written(folder, EXCLUDED, why.strip())


def take_in_again(folder: Path, *, why: str | None = None) -> RunManifest:
    """Undo the exclusion of a run in its manifest, and return the new manifest.

    Args:
        folder: The run folder.
        why: Reason, kept in `exclusions` of the manifest; `NO_REASON` when None or blank.

    Raises:
        NotFound: The folder is not a run folder.
        DataError: The manifest is invalid, or the run is not excluded.
        RecordingError: The run is being recorded.
        OSError: The manifest cannot be written.
    """
    if read_manifest(folder).excluded is None:
        raise DataError("the run is not excluded; there is nothing to undo", file=folder)
    return _written(folder, UNDONE, (why or "").strip() or NO_REASON)


def past_reasons(manifest: RunManifest) -> tuple[str, ...]:
    """Return the reasons of past exclusions, the latest first, without the present exclusion."""
    reasons = [each.get("why", NO_REASON) for each in _history(manifest) if each["did"] == EXCLUDED]
    return tuple(reversed(reasons[:-1] if manifest.excluded is not None else reasons))


def _written(folder: Path, did: str, why: str) -> RunManifest:
    """Write an exclusion, or its undoing, to the manifest, and return that.

    Args:
        folder: The run folder.
        did: `EXCLUDED` or `UNDONE`.
        why: The reason, which is kept with the present time.

    Raises:
        RecordingError: The run is being recorded: its end would undo what is written now.
    """
    require_ended(folder)
    manifest = read_manifest(folder)
    entry = {"did": did, "why": why, "at": datetime.now(UTC).isoformat(timespec="seconds")}
    manifest = replace(
        manifest,
        excluded={"why": why} if did == EXCLUDED else None,
        exclusions=(*_history(manifest), entry),
    )
    write_manifest(folder, manifest)
    return manifest


def _history(manifest: RunManifest) -> tuple[Mapping[str, str], ...]:
    """Return all exclusions and their undoing, with the present exclusion appended if missing.

    An exclusion made by hand or by an earlier version is not in the manifest's list.
    """
    history, now = tuple(manifest.exclusions), manifest.excluded
    excluded = [each.get("why") for each in history if each["did"] == EXCLUDED]
    if now is None or (excluded and excluded[-1] == now.get("why")):
        return history
    return (*history, {"did": EXCLUDED, "why": now.get("why", NO_REASON)})
