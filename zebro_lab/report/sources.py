# SPDX-License-Identifier: MIT
"""Find the result folders that a report shows, and the commands for those that are missing."""

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pandas as pd

from zebro_lab.calibration.folder import SLIP_TOML
from zebro_lab.calibration.walks_folder import FOLDER as WALKS
from zebro_lab.calibration.walks_folder import WALKS_TOML
from zebro_lab.files.documents import read_json_document, read_toml_document
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.names import TRACK
from zebro_lab.files.opening import parsing, read_text
from zebro_lab.files.replacement import recover
from zebro_lab.files.source_names import is_simulated
from zebro_lab.report.pictures import SUFFIXES, VALIDATION, lies_in, place_of
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import MANIFEST_FILE, is_track_alone
from zebro_lab.walk.folder import PREDICTION, measured_sources

MANIFEST, SUMMARY = "manifest.json", "summary.csv"
CALIBRATION = "calibration"
BESIDE: Mapping[str, tuple[str, ...]] = {CALIBRATION: (SLIP_TOML, SUMMARY), WALKS: (WALKS_TOML,)}
"""Files of a stage's result that are read in addition to the manifest, by name of the part."""
_MOST_TABLE = 4 << 20  # bytes of summary.csv, one line per parameter
_AGAIN = "delete it and run the command that wrote it again"
WALK_PARTS = (TRACK, PREDICTION, VALIDATION)
MAKERS: Mapping[str, str] = {
    CALIBRATION: "zebro-lab calibrate {data} --out {folder}",
    WALKS: "zebro-lab calibrate --walks {run} --walks RUN --out {folder}",
    TRACK: "zebro-lab track PHOTOS --camera camera.toml --floor floor.toml --run {run}",
    PREDICTION: "zebro-lab predict {run} --slip calibration --draws 500 --out {folder}",
    VALIDATION: "zebro-lab validate {run} --out {folder}",
}
"""Template of the command that writes each part, by name of the part."""


@dataclass(frozen=True)
class ReportPart:
    """Result folder of a stage as read for a report; if missing, the command that writes it.

    Attributes:
        name: Name of the result: calibration, walks, track, prediction or validation.
        folder: Folder of the result, which may not exist.
        documents: Content of the manifest and other files read, by file name; empty if missing.
        pictures: Existing PNG and SVG files of the folder that its manifest lists, in the order
            shown.
        maker: Command that writes the result.
        not_shown: Pictures that the manifest lists with a path outside the folder.
    """

    name: str
    folder: Path
    documents: Mapping[str, Mapping[str, Any]]
    pictures: Sequence[Path]
    maker: str
    not_shown: Sequence[str] = ()

    @property
    def missing(self) -> bool:
        """Whether the folder has no manifest."""
        return not self.documents

    @property
    def manifest(self) -> Mapping[str, Any]:
        """Content of the result's manifest; empty if the result is missing."""
        return self.documents.get(MANIFEST, {})

    @property
    def source(self) -> str:
        """Where the data come from, as in the manifest; "unknown" if not stated."""
        return str(self.manifest.get("source", "unknown"))

    @property
    def measured(self) -> Sequence[str]:
        """Sources of the data; of a prediction those of what it was computed from."""
        return measured_sources(self.manifest) if self.name == PREDICTION else (self.source,)


@dataclass(frozen=True)
class ReportedRun:
    """One run with its results.

    Attributes:
        folder: The run folder.
        recorded: Content of `run.json`; empty if the folder is not a recorded run.
        parts: Track, prediction and validation, present or missing, by name; none for a run of the
            slip rig, and only those that are present for a run with a track alone.
    """

    folder: Path
    recorded: Mapping[str, Any]
    parts: Mapping[str, ReportPart]

    @property
    def name(self) -> str:
        """Name of the run folder."""
        return self.folder.absolute().name

    @property
    def has_track_alone(self) -> bool:
        """Whether the run was imported from a path alone, without leg angles."""
        return is_track_alone(self.recorded)


@dataclass(frozen=True)
class Sources:
    """All results that a report shows.

    Attributes:
        data: The folder to report on, as named.
        runs: The folder itself if it is a run or has no run in it, else the runs found in it.
        calibration: The calibration, present or missing.
        together: A validation of several runs together, present or missing; None for a report of
            one run.
        walks: Posterior of legs and floor after walks; None if no walks were fitted.
    """

    data: Path
    runs: Sequence[ReportedRun]
    calibration: ReportPart
    together: ReportPart | None = None
    walks: ReportPart | None = None

    @property
    def parts(self) -> Sequence[ReportPart]:
        """All parts, present or missing: calibration, those of the runs, walks, together."""
        walks = [part for run in self.runs for part in run.parts.values()]
        more = [part for part in (self.walks, self.together) if part is not None]
        return [self.calibration, *walks, *more]

    @property
    def hold_more_than_tracks(self) -> bool:
        """Whether any run holds more than an imported path, see `has_track_alone`."""
        return not all(run.has_track_alone for run in self.runs)

    @property
    def missing(self) -> Sequence[ReportPart]:
        """Parts that are missing; the calibration only if there is more than tracks."""
        needed = [p for p in self.parts if p is not self.calibration or self.hold_more_than_tracks]
        return [part for part in needed if part.missing]

    @property
    def simulated(self) -> Sequence[str]:
        """Sources of the data of present parts and of runs with `sim:`, sorted, each once."""
        named = [each for part in self.parts if not part.missing for each in part.measured]
        named += [str(run.recorded.get("source", "")) for run in self.runs]
        return sorted(
            {each.strip() for one in named for each in one.split(",") if is_simulated(each)}
        )


def find_sources(data: Path, *, calibration: Path) -> Sources:
    """Read the results to report on: calibration; track, prediction and validation of each run.

    Args:
        data: A run folder, a folder with track, prediction or validation, or a folder of run
            folders.
        calibration: The calibration folder; it need not exist.

    Raises:
        NotFound: There is no such folder, or no run and no result in it.
        DataError: A manifest is damaged or of another command, or a file of `BESIDE` is missing or
            damaged.
    """
    for name in WALK_PARTS:
        recover(data / name)
    found = find_runs(data)
    own = [name for name in WALK_PARTS if (data / name / MANIFEST).is_file()]
    recover(calibration)
    slip = _part(CALIBRATION, calibration, data)
    walks = _part(WALKS, calibration / WALKS, data)
    walks = None if walks.missing else walks
    if not found and not own:
        raise NotFound(
            f"{data} holds neither a run ({MANIFEST_FILE}) nor a folder {', '.join(WALK_PARTS)} "
            "with results; give a run folder, a folder of run folders, or the folder of results"
        )
    if data in found or not found:
        return Sources(data, [_run(data)], slip, walks=walks)
    together = _part(VALIDATION, data / VALIDATION, data / "*")
    of_all = Sources(data, [_run(folder) for folder in found], slip, together, walks)
    if together.missing and not of_all.hold_more_than_tracks:
        return replace(of_all, together=None)
    return of_all


def _run(folder: Path) -> ReportedRun:
    """Read a run and its parts.

    A run of the slip rig has no parts; a run with a track alone has only those that are present.
    """
    recorded = _read(folder / MANIFEST_FILE) if (folder / MANIFEST_FILE).is_file() else {}
    if recorded.get("kind") == "slip-rig":
        return ReportedRun(folder, recorded, {})
    parts = {name: _part(name, folder / name, folder) for name in WALK_PARTS}
    if is_track_alone(recorded):  # nothing can be predicted from it
        parts = {name: part for name, part in parts.items() if not part.missing}
    return ReportedRun(folder, recorded, parts)


def _part(name: str, folder: Path, data: Path) -> ReportPart:
    """Read a result folder; without a manifest return it as missing, with the command to make it.

    Raises:
        DataError: The manifest is damaged, of another command, or lists its outputs in another
            form; or a file of `BESIDE` is missing or damaged.
    """
    recover(folder)
    maker = MAKERS[name].format(run=data, data=data, folder=folder)
    if not (folder / MANIFEST).is_file():
        return ReportPart(name, folder, {}, (), maker)
    documents = {MANIFEST: _read(folder / MANIFEST)}
    kind = documents[MANIFEST].get("kind")
    expected = ("predict", "walk") if name == PREDICTION else (name,)
    if kind not in expected:
        raise DataError(
            f"'kind' is {kind or 'missing'}, expected {' or '.join(expected)} in this folder",
            file=folder / MANIFEST,
        )
    documents |= {each: _read(folder / each) for each in BESIDE.get(name, ())}
    listed = documents[MANIFEST].get("outputs", {})
    if not isinstance(listed, dict):
        raise DataError(f"'outputs' is {listed!r}; expected an object", file=folder / MANIFEST)
    named = [each for each in sorted(listed, key=place_of) if each.endswith(SUFFIXES)]
    inside = {each: folder / each for each in named if lies_in(folder, each)}
    return ReportPart(
        name, folder, documents, [each for each in inside.values() if each.is_file()], maker,
        tuple(each for each in named if each not in inside),
    )  # fmt: skip


def _rows(file: Path) -> dict[str, dict[str, Any]]:
    """Read a CSV: for each row, by its first cell, a dict of the other cells by header."""
    text = read_text(file, most=_MOST_TABLE)
    with parsing(file, "cannot be read as CSV", advice=_AGAIN):
        return pd.read_csv(io.StringIO(text), index_col=0).to_dict("index")


_READERS: Mapping[str, Callable[[Path], Any]] = {
    ".json": read_json_document,
    ".toml": lambda file: read_toml_document(file, remedy=_AGAIN, fault=DataError),
    ".csv": _rows,
}


def _read(file: Path) -> Mapping[str, Any]:
    """Read a JSON, TOML or CSV file as a mapping; raise `DataError` if it is missing or damaged."""
    try:
        content = _READERS[file.suffix](file)
    except NotFound as error:
        raise DataError("is missing; run the command that writes it again", file=file) from error
    if not isinstance(content, dict):
        raise DataError("is not a JSON object; restore it, or create its folder anew", file=file)
    return content
