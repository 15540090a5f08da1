# SPDX-License-Identifier: MIT
"""Leave a run out of every calibration, or take it in again; every reason stays on record."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from zebro_lab.files.errors import DataError
from zebro_lab.runs.manifest import RunManifest, read_manifest, write_manifest

EXCLUDED: Final = "excluded"
UNDONE: Final = "undone"
UNSAID: Final = "no reason given"


def exclude_run(folder: Path, *, why: str) -> RunManifest:
    """Leave a run out of every calibration from now on, and keep it.

    Args:
        folder: The run folder.
        why: Reason, for whoever reads it later; the reasons of before stay in `exclusions`.

    Raises:
        NotFound: It is no run folder.
        DataError: Its manifest is damaged, or no reason is given.
    """
    if not why.strip():
        raise DataError("no reason given; say why the run is left out", file=folder)
    return _written(folder, EXCLUDED, why.strip())


def take_in_again(folder: Path, *, why: str | None = None) -> RunManifest:
    """Undo the exclusion of a run.

    Args:
        folder: The run folder.
        why: Reason, kept with those for which it was left out.

    Raises:
        NotFound: It is no run folder.
        DataError: Its manifest is damaged, or it is not left out.
    """
    if read_manifest(folder).excluded is None:
        raise DataError("is not left out; there is nothing to undo", file=folder)
    return _written(folder, UNDONE, (why or "").strip() or UNSAID)


def past_reasons(manifest: RunManifest) -> tuple[str, ...]:
    """Return why a run was left out before now, the latest first."""
    reasons = [each.get("why", UNSAID) for each in _history(manifest) if each["did"] == EXCLUDED]
    return tuple(reversed(reasons[:-1] if manifest.excluded is not None else reasons))


def _written(folder: Path, did: str, why: str) -> RunManifest:
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
    """Return what was done; an exclusion of an earlier version, or by hand, is told by itself."""
    history, now = tuple(manifest.exclusions), manifest.excluded
    excluded = [each.get("why") for each in history if each["did"] == EXCLUDED]
    if now is None or (excluded and excluded[-1] == now.get("why")):
        return history
    return (*history, {"did": EXCLUDED, "why": now.get("why", UNSAID)})
