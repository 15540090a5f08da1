# SPDX-License-Identifier: MIT
"""Say which results of a report were changed or do not belong together, by manifests' hashes."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from zebro_lab.calibration.folder import SLIP_TOML
from zebro_lab.calibration.walks_folder import WALKS_TOML
from zebro_lab.files.folder_manifest import changed_output
from zebro_lab.files.names import PATH_CSV, TRACK
from zebro_lab.files.provenance import file_hash
from zebro_lab.report.pictures import VALIDATION, lies_in
from zebro_lab.report.sources import ReportedRun, ReportPart, Sources
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import profile_file
from zebro_lab.runs.profile_streams import LEGS
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.walk.folder import INFORMED_MODEL, PREDICTION


@dataclass(frozen=True)
class Belonging:
    """Whether the results of a report were made from one another.

    Attributes:
        notices: What was changed or does not belong together, one sentence each; empty if no such
            result is known.
        calibration_used: Whether a prediction was made with the calibration as it is now, or there
            is no prediction to say so.
    """

    notices: tuple[str, ...]
    calibration_used: bool


def belonging(sources: Sources) -> Belonging:
    """Compare the files that each result was made from with those of the other results now.

    A result is compared by the hash of its file now; what a manifest does not state is not judged.
    """
    predicted = [run for run in sources.runs if _present(run, PREDICTION)]
    law = _now(sources.calibration, SLIP_TOML)
    users = [run for run in predicted if law is not None and law in _read(run.parts[PREDICTION])]
    used = not predicted or bool(users)
    notices = [notice for run in predicted for notice in _slip(run, sources, law)]
    notices += [notice for run in sources.runs for notice in _walk(run)]
    if sources.walks is not None:
        notices += _not_from(
            "the fit of walks", sources.walks, {str(sources.calibration.folder): law}
        )
    notices += _together(sources)
    notices += _changed(sources)
    return Belonging(tuple(dict.fromkeys(notices)), used)


def _slip(run: ReportedRun, sources: Sources, law: str | None) -> Iterator[str]:
    """Say that a prediction used another slip law, or another fit of walks, than those shown."""
    prediction, walks = run.parts[PREDICTION], sources.walks
    if law is not None and law not in _read(prediction):
        yield (
            f"{run.name}: the prediction was made with {_named_slip(prediction)}, not with the "
            f"calibration in {sources.calibration.folder} as it is now; predict again, or name "
            "the calibration that was used with --calibration"
        )
        return
    informed = any(Path(name).name == WALKS_TOML for name in _inputs(prediction))
    if walks is None:
        if law is not None and informed:
            yield (
                f"{run.name}: the prediction used a fit of walks that "
                f"{sources.calibration.folder} no longer has; predict again"
            )
    elif _now(walks, WALKS_TOML) not in _read(prediction) and _takes_walks(prediction):
        yield (
            f"{run.name}: the prediction was made without the fit of walks in {walks.folder} as "
            "it is now; predict again"
        )


def _walk(run: ReportedRun) -> Iterator[str]:
    """Say which of prediction, track and validation were not made from this run as it is now."""
    if run.recorded and _present(run, PREDICTION):
        yield from _predicted(run, run.parts[PREDICTION])
    if run.recorded and _present(run, TRACK):
        yield from _tracked(run, run.parts[TRACK])
    if _present(run, VALIDATION):
        yield from _judged(run, run.parts[VALIDATION])


def _not_from(what: str, result: ReportPart, files: Mapping[str, str | None]) -> Iterator[str]:
    """Yield a sentence for each file that a result was not made from.

    Args:
        what: Name of the result.
        result: The result, whose manifest lists the hashes of what it was made from.
        files: Hash of each file, by name; one whose hash is not known (None) is skipped.
    """
    for file, digest in files.items():
        if digest is not None and digest not in _read(result):
            yield f"{what} was not made from {file} as it is now; make it again"


def _predicted(run: ReportedRun, prediction: ReportPart) -> Iterator[str]:
    """Say which of a run's files with leg angles a prediction was not made from.

    Nothing is said if it was made from the table that the run was imported from.
    """
    imported = _mapping(run.recorded.get("inputs"))
    tables = {str(digest) for name, digest in imported.items() if Path(name).suffix != ".toml"}
    if not tables & _read(prediction):  # else made from the table that the run was imported from
        yield from _not_from(f"{run.name}: the prediction", prediction, _leg_files(run))


def _tracked(run: ReportedRun, track: ReportPart) -> Iterator[str]:
    """Say that an imported track was not imported with the run."""
    imported = set(map(str, _mapping(run.recorded.get("inputs")).values()))
    is_imported = "imported" in _mapping(track.manifest.get("settings"))
    if is_imported and imported and not _read(track) <= imported:
        yield f"{run.name}: the track was imported from other files than the run"


def _judged(run: ReportedRun, validation: ReportPart) -> Iterator[str]:
    """Say which of a run's prediction and track is not the one that a validation judged."""
    parts = {name: run.parts[name] for name in (PREDICTION, TRACK) if _present(run, name)}
    files = {PREDICTION: PATH_CSV, TRACK: TRACK_CSV}
    judged = {str(part.folder / files[name]): _now(part, files[name])
              for name, part in parts.items()}  # fmt: skip
    yield from _not_from(f"{run.name}: the validation in {validation.folder}", validation, judged)


def _together(sources: Sources) -> Iterator[str]:
    """Say which predictions and tracks are not those that a validation of several runs judged."""
    together = sources.together
    if together is None or together.missing:
        return
    judged = _mapping(together.manifest.get("runs"))
    for run in sources.runs:
        if run.name in judged:
            yield from _judged(run, together)


def _changed(sources: Sources) -> Iterator[str]:
    """Say which slip laws, fits of walks, paths and tracks were changed since they were written."""
    for part in sources.parts:
        for name in (SLIP_TOML, WALKS_TOML, PATH_CSV, TRACK_CSV):
            yield from changed_output(part.folder / name)


def _leg_files(run: ReportedRun) -> Mapping[str, str]:
    """Return the hashes of the files that hold a run's leg angles: its log and the robot's profile.

    They are by name; that of the log is the one stated in `run.json`, else that of the file now. A
    file that is missing is left out.
    """
    log, profile = run.folder / LOG_FILE, profile_file(run.folder, LEGS)
    stated = run.recorded.get("log_sha256")
    found = {} if not isinstance(stated, str) else {LOG_FILE: stated}
    files = [file for file in (log, profile) if file.is_file() and file.name not in found]
    return found | {file.name: file_hash(file) for file in files}


def _present(run: ReportedRun, name: str) -> bool:
    """Return whether a run has this result, of prediction, track and validation."""
    return name in run.parts and not run.parts[name].missing


def _named_slip(prediction: ReportPart) -> str:
    """Return "slip 'NAME'" by a prediction's manifest; "no slip law" if it names none."""
    slip = _mapping(_mapping(prediction.manifest.get("settings")).get("slip"))
    return f"slip '{slip['named']}'" if "named" in slip else "no slip law"


def _takes_walks(prediction: ReportPart) -> bool:
    """Return whether the prediction's model takes legs and floor from fitted walks."""
    return _mapping(prediction.manifest.get("settings")).get("model") == INFORMED_MODEL


def _now(part: ReportPart, name: str) -> str | None:
    """Return the hash of a result's file as it is now; without the file as its manifest states.

    None if neither is known, or the result is missing.
    """
    if lies_in(part.folder, name) and (part.folder / name).is_file():
        return file_hash(part.folder / name)
    stated = _mapping(part.manifest.get("outputs")).get(name)
    return None if part.missing or stated is None else str(stated)


def _read(part: ReportPart) -> set[str]:
    """Return the hashes of all files that a result was made from."""
    return set(map(str, _inputs(part).values()))


def _inputs(part: ReportPart) -> Mapping[str, object]:
    """Return the hash of each file that a result was made from, by name; empty if not stated."""
    return _mapping(part.manifest.get("inputs"))


def _mapping(value: object) -> Mapping[str, object]:
    """Return a value of a manifest if it is a mapping, else an empty one."""
    return value if isinstance(value, Mapping) else {}
