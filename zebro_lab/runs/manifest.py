# SPDX-License-Identifier: MIT
"""Read, check and write the manifest `run.json` of a run folder."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, TypeAlias

from pydantic import AfterValidator, ConfigDict, TypeAdapter, ValidationError

from model.similar_name import nearest
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.documents import json_text
from zebro_lab.files.errors import DataError
from zebro_lab.files.folder_manifest import read_json_object
from zebro_lab.files.provenance import software_commit

PROFILES = "profiles"
MANIFEST_FILE = "run.json"
SCHEMA_VERSION = 1
RIG_KIND, WALK_KIND = "slip-rig", "walk"
KINDS = (RIG_KIND, WALK_KIND)
IMPORTED = "imported"
RIG = "rig"
"""Name of the rig's profile in a run folder, for all streams of the rig."""
TABLE = "table"
"""Name of the profile for samples imported from a table, already decoded and cut into runs."""
RECORDING = "recording"
"""Exit status of a run that has not ended yet, or whose recorder was killed."""


def profile_file(folder: Path, stream: str) -> Path:
    """Return the path of a stream's profile in a run folder, `profiles/STREAM.toml`.

    The run is decoded with this file, so that a wrong profile can be corrected afterwards.

    Args:
        folder: Run folder.
        stream: Name of the stream; `RIG` for all streams of the rig.
    """
    return folder / PROFILES / f"{stream}.toml"


def software_version() -> dict[str, str]:
    """Return the installed `version` of zebro-lab, "unknown" if it is not installed, and `commit`.

    The commit has the form of `zebro_lab.files.provenance.software_commit`.
    """
    try:
        installed = version("zebro-lab")
    except PackageNotFoundError:
        installed = "unknown"
    return {"version": installed, "commit": software_commit()}


def _moment(text: str) -> str:
    """Return a date and time in ISO 8601; ValueError without a time zone or beyond year 9999."""
    moment = datetime.fromisoformat(text)
    try:
        moment.astimezone(UTC)
    except OverflowError as error:
        raise ValueError("is no time in UTC") from error
    if moment.tzinfo is None:
        raise ValueError("lacks a time zone")
    return text


Moment: TypeAlias = Annotated[str, AfterValidator(_moment)]


@dataclass(frozen=True, kw_only=True)
class RunManifest:
    """Content of the `run.json` of a run; before the run, the entries known by then.

    Attributes:
        kind: "slip-rig" or "walk".
        label: Name given by the operator.
        material: Leg and ground material.
        operator: Name of the operator.
        source: "real", "sim:what", "replay:what", "sim:replay:what" for a replay of simulated data,
            "mixed:A,B" of different streams; of an imported run the source that its file states, or
            "import:FILE".
        start: Start, UTC, ISO 8601; empty before the run.
        stop: Stop, UTC, ISO 8601; None while the run is recorded, or if the recorder died.
        exit_status: "completed", "recording", "imported", or why the run ended.
        software: Version and commit of the recording software, by "version" and "commit".
        constants: Canonical columns that are one number for the rig, SI: radius_leg,
            radius_ground; also zero_normal and zero_traction [N], where the unloaded load cell's
            zero is to be subtracted. NaN is unknown, and null in the file.
        streams: Number of samples recorded, by topic; empty before the end.
        log_sha256: SHA-256 of `log.mcap`; None before the end, or if the recorder could not close
            the log.
        excluded: {"why": reason} if the run is excluded from every calibration, else None.
        exclusions: Exclusions and their undoing, in order: {"did": "excluded" or "undone", "why":
            reason, "at": time}.
        profiles: Name of each device's profile, by its file in the folder (`profile_file`); empty
            in runs of an early version, whose log has samples in SI: they are listed, not read.
        sources: Source of each stream, by the stream's name.
        counters: Numbers of samples received, lost, damaged and so on, and of those that the
            recorder dropped, by stream.
        clocks: Attributes of `ClockFit` of each device's clock, by stream, for devices that send
            their time: time of the run = offset + (1 + drift) device time. The delay is the median
            time by which the quickest sample of each interval of 50 ms, or more, arrives later than
            that.
        duration: Requested duration ("asked") and the time of the run from which it counts
            ("from"), when every stream had sent its first sample; empty for a run without a set
            duration [s].
        robot: Name of the robot, as given or as its file's; None if unknown.
        truth: True values of a simulated rig; else empty.
        inputs: SHA-256 of the files that an imported run was made from, by their paths.
        point: Plan, number and attempt of the experiment's point that the run measures, and
            whether it is accepted; empty outside experiments.
        seed: Seed of the random numbers of a recording's simulated devices; None without such.
        schema_version: Version of the manifest's format.
    """

    kind: str
    label: str
    material: str = "unknown"
    operator: str = "unknown"
    source: str
    start: Moment = ""
    stop: Moment | None = None
    exit_status: str = RECORDING
    software: Mapping[str, str] = field(default_factory=software_version)
    constants: Mapping[str, float] = field(default_factory=dict)
    streams: Mapping[str, int] = field(default_factory=dict)
    log_sha256: str | None = None
    excluded: Mapping[str, str] | None = None
    exclusions: Sequence[Mapping[str, str]] = ()
    profiles: Mapping[str, str] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    counters: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    clocks: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    duration: Mapping[str, float] = field(default_factory=dict)
    robot: str | None = None
    truth: Mapping[str, Any] = field(default_factory=dict)
    inputs: Mapping[str, str] = field(default_factory=dict)
    point: Mapping[str, Any] = field(default_factory=dict)
    seed: int | None = None
    schema_version: int = SCHEMA_VERSION
    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(strict=True)

    @property
    def began(self) -> datetime:
        """Start of the run as a datetime with its time zone; ValueError before the run."""
        return datetime.fromisoformat(self.start)

    @property
    def is_track_alone(self) -> bool:
        """Whether the run was imported from the path of another program alone."""
        return is_track_alone(asdict(self))


def is_track_alone(manifest: Mapping[str, Any]) -> bool:
    """Return whether entries of a `run.json` are of a run with a track and no log.

    Args:
        manifest: The entries, `kind`, `exit_status` and `streams` among them.
    """
    imported = manifest.get("kind") == "walk" and manifest.get("exit_status") == IMPORTED
    return imported and not manifest.get("streams")


def read_manifest(folder: Path) -> RunManifest:
    """Read and check a run folder's `run.json`.

    Raises:
        NotFound: The manifest does not exist.
        DataError: The manifest is no JSON object, lacks an entry, is of another schema version or
            an unknown kind, or an entry has the wrong type, or is a time without time zone.
    """
    file = folder / MANIFEST_FILE
    return _checked(read_json_object(file, of="run folder"), file)


def write_manifest(folder: Path, manifest: RunManifest) -> Path:
    """Write the `run.json` of a run folder atomically.

    Args:
        folder: Run folder.
        manifest: Content to write.

    Returns:
        The file written.

    Raises:
        OSError: The folder cannot be written.
    """
    return atomic_write_text(folder / MANIFEST_FILE, manifest_text(manifest))


def manifest_text(manifest: RunManifest) -> str:
    """Format a manifest as JSON text; fields that are None, and empty optional ones, are omitted.

    Optional are stop, log_sha256, excluded, and exclusions and all fields after it except
    schema_version.
    """
    document = {
        key: value for key, value in asdict(manifest).items()
        if value is not None and (value or value == 0 or key not in _OPTIONAL)
    }  # fmt: skip
    return json_text(document) + "\n"


_OPTIONAL = {
    "stop", "log_sha256", "excluded", "exclusions", "profiles", "sources", "counters", "clocks",
    "duration", "robot", "truth", "inputs", "point", "seed",
}  # fmt: skip
_REQUIRED = tuple(each.name for each in fields(RunManifest) if each.name not in _OPTIONAL)
_EXPECTED: Final = {
    "string_type": "a text",
    "float_type": "a number",
    "int_type": "a whole number",
    "dict_type": "an object",
    "list_type": "a list",
    "value_error": "a date and time with a time zone, such as 2026-01-01T12:00:00+00:00",
}
"""What an entry should be, by pydantic's type of the error."""
_CHECK: Final = TypeAdapter(RunManifest)


def _checked(document: Mapping[str, Any], file: Path) -> RunManifest:
    """Check the entries of a `run.json` and return them as a manifest; raise `DataError` otherwise.

    A null is taken as not given, so that a required entry is missing; in `constants` it is NaN.
    """
    if document.get("schema_version") != SCHEMA_VERSION:
        raise DataError(
            f"'schema_version' is {in_json(document, 'schema_version')}, expected "
            f"{SCHEMA_VERSION}; use the version of zebro-lab that wrote this file",
            file=file,
        )
    try:
        entries = dict.fromkeys(_REQUIRED) | _without_unknown(document)
        if isinstance(document.get("constants"), dict):  # an unknown one must not count as 0
            entries["constants"] = {
                key: math.nan if each is None else each
                for key, each in document["constants"].items()
            }
        manifest = _CHECK.validate_json(json.dumps(entries))
    except ValidationError as error:
        found = error.errors()[0]
        if not found["loc"]:  # half of a pair of surrogates
            raise DataError(f"is not read: {found['msg']}", file=file) from error
        name, *inner = map(str, found["loc"])
        what = f"is {in_json(document, name)}"
        if inner:
            what = f"has '{'.'.join(inner)}': {found['input']!r}"
        expected = _EXPECTED.get(found["type"], found["msg"])
        raise DataError(f"'{name}' {what}, expected {expected}", file=file) from error
    if manifest.kind not in KINDS:
        raise DataError(f"'kind' is '{manifest.kind}'; {nearest(manifest.kind, KINDS)}", file=file)
    for each in manifest.exclusions:
        if not {"did", "why"} <= each.keys():
            raise DataError(f"an entry of 'exclusions' lacks 'did' or 'why': {each!r}", file=file)
    return manifest


def _without_unknown(value: Any) -> Any:
    """Return a value without the entries that are null, in nested tables too."""
    if isinstance(value, dict):
        return {key: _without_unknown(each) for key, each in value.items() if each is not None}
    return [_without_unknown(each) for each in value] if isinstance(value, list) else value


def in_json(document: Mapping[str, Any], name: str) -> str:
    """Format a value of a JSON object as JSON, for an error message; `missing` without the key.

    Args:
        document: The object.
        name: Key of the value.
    """
    return json.dumps(document[name], ensure_ascii=False) if name in document else "missing"
