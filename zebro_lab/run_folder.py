# SPDX-License-Identifier: MIT
"""Run folders: `DATA/<utc time>_<kind>_<label>/` with `run.json` and `log.mcap`.

This file alone knows their form, which docs/formats.md describes.
"""

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime, timedelta
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from zebro_lab.atomic import atomic_folder
from zebro_lab.columns import nearest
from zebro_lab.errors import AlreadyExists, DataError, NotFound
from zebro_lab.slip_rig_log import TOPIC, SlipRigTable, read_log, write_log

MANIFEST_FILE = "run.json"
LOG_FILE = "log.mcap"
SCHEMA_VERSION = 1
KINDS = ("slip-rig", "walk")


@dataclass(frozen=True)
class RunManifest:
    """What `run.json` says about a run.

    Attributes:
        kind: "slip-rig" or "walk".
        label: Name its operator gave it.
        material: Leg and ground material.
        operator: Who ran it.
        source: "real", "sim:what" or "replay:what".
        start: Start, UTC, ISO 8601.
        stop: Stop, UTC, ISO 8601.
        exit_status: "completed", or why it ended.
        software: Version and commit of what recorded it.
        constants: Canonical columns that are one number for the rig, SI: radius_leg,
            radius_ground.
        streams: Samples recorded, by topic.
        log_sha256: SHA-256 of `log.mcap`; None where the recorder could not close it.
        excluded: {"why": reason} where the run is to be left out of every calibration.
        schema_version: Version of this form.
    """

    kind: str
    label: str
    material: str
    operator: str
    source: str
    start: str
    stop: str
    exit_status: str
    software: Mapping[str, str]
    constants: Mapping[str, float]
    streams: Mapping[str, int]
    log_sha256: str | None = None
    excluded: Mapping[str, str] | None = None
    schema_version: int = SCHEMA_VERSION


@dataclass(frozen=True)
class SlipRigRun:
    """A run of the slip rig, as read.

    Attributes:
        folder: Its folder.
        manifest: What `run.json` says.
        table: The samples.
        files: Files read.
        notes: What a person should know about how it was read.
    """

    folder: Path
    manifest: RunManifest
    table: SlipRigTable
    files: tuple[Path, ...]
    notes: tuple[str, ...] = field(default=())


def write_slip_rig_run(
    data_dir: Path,
    table: SlipRigTable,
    *,
    label: str,
    material: str,
    operator: str,
    source: str,
    start: datetime,
    radius_leg: float,
    radius_ground: float,
    exit_status: str = "completed",
    commit: str = "unknown",
) -> Path:
    """Write a run of the slip rig as a new run folder, atomically.

    Args:
        data_dir: Folder of run folders; made when missing.
        table: The samples, at least one.
        label: Name of the run.
        material: Leg and ground material.
        operator: Who ran it.
        source: "real", "sim:what" or "replay:what".
        start: When sample time was 0, with its time zone.
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].
        exit_status: How the run ended.
        commit: Commit of the software that recorded it.

    Returns:
        The run folder.

    Raises:
        DataError: There is no sample.
        AlreadyExists: A run of this start and label is there already.
    """
    if len(table) == 0:
        raise DataError(f"run '{label}' has no samples to write")
    start = start.astimezone(UTC)
    folder = Path(data_dir) / f"{start:%Y%m%dT%H%M%SZ}_slip-rig_{_slug(label)}"
    if folder.exists():
        raise AlreadyExists(f"{folder} exists already; give the run another label")
    with atomic_folder(folder) as draft:
        with (draft / LOG_FILE).open("wb") as file:
            write_log(file, table, start_ns=_epoch_ns(start))
        manifest = RunManifest(
            kind="slip-rig",
            label=label,
            material=material,
            operator=operator,
            source=source,
            start=start.isoformat(),
            stop=(start + timedelta(seconds=float(table.t[-1]))).isoformat(),
            exit_status=exit_status,
            software={"version": _software_version(), "commit": commit},
            constants={"radius_leg": float(radius_leg), "radius_ground": float(radius_ground)},
            streams={TOPIC: len(table)},
            log_sha256=_sha256(draft / LOG_FILE),
        )
        text = json.dumps(_without_none(asdict(manifest)), indent=2, ensure_ascii=False)
        (draft / MANIFEST_FILE).write_text(text + "\n", encoding="utf-8")
    return folder


def read_manifest(folder: Path) -> RunManifest:
    """Read and check a run folder's `run.json`.

    Raises:
        NotFound: There is none.
        DataError: It is damaged, incomplete, or of another version.
    """
    file = folder / MANIFEST_FILE
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise NotFound(f"{folder} is no run folder: it has no {MANIFEST_FILE}") from error
    except (OSError, ValueError) as error:
        raise DataError(f"cannot be read as JSON: {error}", file=file) from error
    if not isinstance(document, dict):
        raise DataError("is not a JSON object", file=file)
    return _checked(document, file)


def read_slip_rig_run(folder: Path) -> SlipRigRun:
    """Read a run of the slip rig.

    A log that was cut short is read up to its last whole chunk, and a note says so.

    Raises:
        NotFound: There is no manifest or no log.
        DataError: The run is of another kind, or its log cannot be read or is not the one
            that was recorded.
    """
    manifest = read_manifest(folder)
    if manifest.kind != "slip-rig":
        raise DataError(
            f"is a run of kind '{manifest.kind}', expected 'slip-rig'; leave it out",
            file=folder / MANIFEST_FILE,
        )
    path = folder / LOG_FILE
    if not path.is_file():
        raise NotFound(f"{path}: missing; restore it from where the run was recorded")
    log = read_log(path)
    _require_radii(manifest, folder / MANIFEST_FILE)
    if log.damage is not None:
        notes = (_salvage_note(folder, manifest, len(log.table), log.damage),)
    else:
        _require_recorded(path, manifest)
        notes = ()
    return SlipRigRun(folder, manifest, log.table, (folder / MANIFEST_FILE, path), notes)


def _checked(document: Mapping[str, Any], file: Path) -> RunManifest:
    found = document.get("schema_version")
    if found != SCHEMA_VERSION:
        raise DataError(
            f"schema_version is {found!r}, expected {SCHEMA_VERSION}; "
            f"read it with the version of zebro-lab that wrote it",
            file=file,
        )
    optional = {"log_sha256", "excluded"}
    for name, expected in _FIELD_TYPES.items():
        if name in optional and document.get(name) is None:
            continue
        if not isinstance(document.get(name), expected):
            raise DataError(
                f"'{name}' is {document.get(name)!r}, expected {expected.__name__}", file=file
            )
    if document["kind"] not in KINDS:
        raise DataError(f"unknown kind '{document['kind']}'; {nearest(document['kind'], KINDS)}",
                        file=file)  # fmt: skip
    return RunManifest(**{name: document[name] for name in _FIELD_TYPES if name in document})


_FIELD_TYPES: Mapping[str, type] = {
    "kind": str, "label": str, "material": str, "operator": str, "source": str, "start": str,
    "stop": str, "exit_status": str, "software": dict, "constants": dict, "streams": dict,
    "log_sha256": str, "excluded": dict,
}  # fmt: skip


def _require_radii(manifest: RunManifest, file: Path) -> None:
    for name in ("radius_leg", "radius_ground"):
        radius = manifest.constants.get(name)
        if isinstance(radius, bool) or not isinstance(radius, (int, float)):
            raise DataError(
                f"constants.{name} is {radius!r}, expected a radius in m", file=file, column=name
            )
        if not (np.isfinite(radius) and radius > 0):
            raise DataError(
                f"is {radius:g} m, expected more than 0", file=file, column=name, value=radius,
                unit="m",
            )  # fmt: skip


def _require_recorded(path: Path, manifest: RunManifest) -> None:
    if manifest.log_sha256 is not None and _sha256(path) != manifest.log_sha256:
        raise DataError(
            f"is not the log that was recorded: its SHA-256 differs from {MANIFEST_FILE}; "
            f"restore it, or exclude the run in {MANIFEST_FILE}",
            file=path,
        )


def _salvage_note(folder: Path, manifest: RunManifest, count: int, damage: str) -> str:
    recorded = manifest.streams.get(TOPIC)
    of_all = f" of {recorded}" if recorded else ""
    return f"{folder.name}: {LOG_FILE} is cut short ({damage}); {count}{of_all} samples read"


def _slug(label: str) -> str:
    return re.sub(r"[^\w.-]+", "-", label).strip("-.") or "run"


def _epoch_ns(moment: datetime) -> int:
    return (moment - datetime(1970, 1, 1, tzinfo=UTC)) // timedelta(microseconds=1) * 1000


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _software_version() -> str:
    try:
        return version("zebro-lab")
    except PackageNotFoundError:
        return "unknown"


def _without_none(document: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in document.items() if value is not None}
