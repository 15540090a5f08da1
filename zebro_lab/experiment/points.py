# SPDX-License-Identifier: MIT
"""Find the finished points of an experiment from the end records of its run folders.

A run is excluded from calibrations from its start. Its end record (`run.json`, replaced atomically)
holds the verdict on its point and includes an accepted one. A run that a crash interrupts is
therefore either finished and included, or neither.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from rig.experiment.sink import RunStart
from rig.experiment.verdict import PointVerdict
from rig.slip_rig.decode import Zero
from zebro_lab.experiment.journal import Journal
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.runs.exclusion import exclude_run
from zebro_lab.runs.folder import LOG_FILE, require_recorded
from zebro_lab.runs.manifest import MANIFEST_FILE, RunManifest, read_manifest

ZEROS: Final = {"zero_normal", "zero_traction"}
"""Constants of a run that hold the zero of the load cell [N]."""
UNJUDGED: Final = "the run ended before its point was accepted; --resume measures it again"
"""Reason for which a run is excluded until its end record holds a verdict."""


@dataclass(frozen=True)
class Finished:
    """Finished points of earlier runs of a plan.

    Attributes:
        numbers: Numbers of the points in the plan that are finished.
        notices: Messages on runs left out, lost or damaged, one line each.
        zero: Zero of the load cell of the latest of these runs; None without one.
    """

    numbers: frozenset[int]
    notices: tuple[str, ...]
    zero: Zero | None


def point_record(plan: str, start: RunStart, *, accepted: bool) -> dict[str, Any]:
    """Return the `point` entry of an end record: plan, number, attempt, and whether it is accepted.

    Args:
        plan: Fingerprint of the plan.
        start: Point and attempt.
        accepted: Whether the point passed its quality checks.
    """
    number, attempt = start.point.number, start.attempt
    return {"plan": plan, "number": number, "attempt": attempt, "accepted": accepted}


def why_excluded(verdict: PointVerdict | None, reason: str, failure: str | None) -> str:
    """Return the reason for excluding a run: failure, else why it ended, else failed checks.

    Why it ended, `reason`, counts only without a verdict: the run was aborted.
    """
    if failure is not None:
        return failure
    return reason if verdict is None else "; ".join(verdict.problems)


def finished_points(data: Path, journal: Journal) -> Finished:
    """Find the points of a plan that are finished; exclude runs that repeat one or lost their log.

    A run is excluded by an entry in its `run.json`. Other recordings and plans are left as they
    are. A point counts as finished also if its accepted run was excluded since.

    Args:
        data: Folder of the experiment; the caller holds its lock.
        journal: Journal of the experiment.

    Raises:
        OSError: A `run.json` cannot be written.
    """
    numbers: set[int] = set()
    manifests, notices = _read_all(data)
    # Runs that count come first: where a point has two, it is one of them that stays.
    for run, manifest in sorted(manifests, key=lambda item: item[1].excluded is not None):
        number = _accepted(manifest, journal)
        if number is None:
            continue
        if (lost := _lost_log(run, manifest)) is not None:
            notices.append(f"{lost}; point {number} is measured again")
            if manifest.excluded is None:
                exclude_run(run, why="log missing or changed; its point is measured again")
        elif number not in numbers:
            numbers.add(number)
        elif manifest.excluded is None:
            why = f"point {number} was finished in another run"
            exclude_run(run, why=why)
            notices.append(f"{run.name}: {why}; this run is excluded")
    notices += [f"{name}: the run folder is missing; its point is measured again if in no other run"
                for name in sorted(journal.accepted)
                if not os.path.lexists(data / name)]  # fmt: skip
    zero = None
    for _, manifest in manifests:  # by name, and so by time
        if manifest.point.get("plan") == journal.plan and set(manifest.constants) >= ZEROS:
            zero = Zero(*(manifest.constants[name] for name in sorted(ZEROS)), standard_error=0.0)
    return Finished(frozenset(numbers), tuple(notices), zero)


def holds_points(data: Path) -> bool:
    """Return whether any run folder in `data` is a point of an experiment, whatever its plan.

    Folders whose manifest cannot be read do not count.
    """
    return any(manifest.point for _, manifest in _read_all(data)[0])


def point_sources(data: Path) -> frozenset[str]:
    """Return the sources ("real", "sim:what") of all points of experiments in a folder."""
    return frozenset(manifest.source for _, manifest in _read_all(data)[0] if manifest.point)


def _read_all(data: Path) -> tuple[list[tuple[Path, RunManifest]], list[str]]:
    """Read the manifests of the run folders directly in `data`, with their folders, by name.

    The second list has a notice for each that cannot be read.
    """
    manifests: list[tuple[Path, RunManifest]] = []
    notices: list[str] = []
    for run in sorted(file.parent for file in data.glob(f"*/{MANIFEST_FILE}")):
        try:
            manifests.append((run, read_manifest(run)))
        except ZebroLabError as error:
            notices.append(f"{error}; if the run finished a point, that is measured again")
    return manifests, notices


def _lost_log(run: Path, manifest: RunManifest) -> str | None:
    """Return a sentence if a run's log is missing or differs from the checksum in its manifest.

    None if it is intact; without a checksum in the manifest, any file counts as intact.
    """
    log = run / LOG_FILE
    if not log.is_file():  # nor is a FIFO one, which would be waited for
        return f"{run.name}/{LOG_FILE} is missing"
    try:
        require_recorded(log, manifest)
    except (ZebroLabError, OSError) as error:
        return str(error)
    return None


def _accepted(manifest: RunManifest, journal: Journal) -> int | None:
    """Return the number of the point of this plan that a run has finished; None without one."""
    point: Mapping[str, Any] = manifest.point
    if point.get("plan") != journal.plan or point.get("accepted") is not True:
        return None
    number = point.get("number")
    return number if type(number) is int else None
