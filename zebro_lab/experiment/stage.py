# SPDX-License-Identifier: MIT
"""Run an experiment from a plan file into run folders and a journal."""

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Final

from rig.errors import InUse
from rig.exclusive import folder_lock
from rig.experiment.control import Control
from rig.experiment.control_server import ControlServer
from rig.experiment.plan import WATCHDOG_PROOF, Plan
from rig.experiment.run import RunOutcome, run_plan
from rig.experiment.sink import ExperimentWatcher
from rig.experiment.supervision import repeating, signal_stops, supervised
from rig.safety import StopCategory
from zebro_lab.experiment.folder import ExperimentFolder
from zebro_lab.experiment.journal import (
    JOURNAL_FILE,
    Journal,
    begin_or_resume,
    plan_fingerprint,
)
from zebro_lab.experiment.latch import EmergencyLatch
from zebro_lab.experiment.opened_rig import OpenedRig, opened_rig
from zebro_lab.experiment.plan_stage import read_plan, require_plan_allowed
from zebro_lab.experiment.points import Finished, finished_points, holds_points, point_sources
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.say_stage import CONTROL_FILE
from zebro_lab.files.errors import (
    AlreadyExists,
    RecordingError,
    SettingsError,
)
from zebro_lab.runs.folder import removing_new_folders
from zebro_lab.runs.manifest import MANIFEST_FILE, RunManifest

LOOK_EVERY: Final = 0.05
"""Interval between looks at the emergency latch, which another program may set [s]."""


def run_experiment(
    request: RigRunRequest, watcher: ExperimentWatcher, control: Control
) -> RunOutcome:
    """Run a plan on a rig, and record each attempt at a point into a run folder of its own.

    Args:
        request: Options of `zebro-lab rig run`.
        watcher: Progress display.
        control: Mailbox for pauses, notes and stops; signals and the control socket feed it.

    Returns:
        The outcome of the run.

    Raises:
        ZebroLabError: The plan, the folder or an option is invalid, an emergency stop is latched,
            or the folder holds another experiment; nothing moved.
        InUse: Another program runs an experiment into this folder, or uses a device.
        RigError: The address or the profile is invalid, or a set-point exceeds a limit: nothing
            moved. Or a guard, device, thread or the disk stopped the run: the drives are
            de-energised.
    """
    plan = read_plan(request.plan)
    if request.no_watchdog_proof:
        off = (*plan.limits.guards_off, WATCHDOG_PROOF)
        plan = replace(plan, limits=replace(plan.limits, guards_off=off))
    with opened_rig(
        request.rig, seed=request.seed, run=_run_name(request), fast=request.fast
    ) as rig:
        require_plan_allowed(request.plan, plan, rig.bench.profile)
        load = rig.load_setter(plan.load, control)
        with removing_new_folders(request.data), _owned(request.data):
            journal, finished = _begin(request, source=rig.bench.source)
            for notice in finished.notices:
                watcher.notice(notice)
            folder = ExperimentFolder(
                request.data, plan=journal.plan, manifest=_manifest(plan, rig),
                profiles=rig.profiles, streams=rig.bench.streams, clock=rig.clock, in_step=rig.fast,
            )  # fmt: skip
            with _recording(folder, request.data, control):
                for notice in finished.notices:
                    folder.event("warning", notice)
                return run_plan(
                    plan, bench=rig.bench, load=load, sink=folder, control=control,
                    watcher=watcher, clock=rig.clock, period=rig.period, done=finished.numbers,
                    zero=finished.zero,
                )  # fmt: skip


def _run_name(request: RigRunRequest) -> str:
    """Name this run, for the noise of a twin, by folder, plan and attempts that are there already.

    So a second experiment on one simulated rig, or one that is resumed, has noise of its own, and
    the same command repeated from nothing gives the same data.
    """
    attempts = len(list(request.data.glob(f"*/{MANIFEST_FILE}")))
    plan = plan_fingerprint(request.plan.read_text(encoding="utf-8"))
    return f"{request.data.resolve().name} {plan} {attempts}"


def _begin(request: RigRunRequest, *, source: str) -> tuple[Journal, Finished]:
    """Start or resume the journal as the options say, and find the points that are finished.

    Args:
        request: Options of `zebro-lab rig run`.
        source: Source of the samples of this run, "real" or "sim:what".

    Raises:
        SettingsError: Points of the experiment to resume have another source.
        ZebroLabError: See `begin_or_resume`.
    """
    _require_no_points(request.data)
    if request.resume:
        _require_same_source(request.data, source)
    journal = begin_or_resume(
        request.data, request.plan.read_text(encoding="utf-8"), resume=request.resume,
        reset=request.reset_emergency,
    )  # fmt: skip
    return journal, finished_points(request.data, journal)


@contextmanager
def _recording(folder: ExperimentFolder, data: Path, control: Control) -> Iterator[None]:
    """Open the writer, serve the control socket, and stop on signals and thread failures.

    An emergency stop that is latched in `control` at the end is latched on disk, too.
    """
    commandable = _commandable(data.resolve(), control)
    with signal_stops(control.stop), supervised(control), folder, commandable:
        try:
            yield
        finally:
            stop = control.stop.pending
            if stop is not None and control.stop.latched:  # it may have come at the end
                folder.latch(stop.reason)


def _manifest(plan: Plan, rig: OpenedRig) -> RunManifest:
    """Return the manifest entries common to all runs of an experiment, from plan and rig."""
    return RunManifest(
        kind="slip-rig",
        label=plan.name,
        source=rig.bench.source,
        material=plan.material,
        operator=plan.operator or "unknown",
        constants=rig.constants,
        sources={stream.name: stream.source for stream in rig.bench.streams},
        truth=rig.truth,
    )


def _require_no_points(data: Path) -> None:
    """Raise AlreadyExists where points exist without a journal: repeated, they'd count twice."""
    if not (data / JOURNAL_FILE).exists() and holds_points(data):
        raise AlreadyExists(
            f"{data} holds points of an experiment, but {JOURNAL_FILE} is missing; restore that "
            "file, or choose another folder with --data"
        )


def _require_same_source(data: Path, source: str) -> None:
    """Raise SettingsError where points were measured on another source, such as a simulated rig."""
    others = point_sources(data) - {source}
    if others:
        raise SettingsError(
            f"has points measured on '{', '.join(sorted(others))}', and this rig is '{source}': "
            "these are two experiments; give the same --rig, or choose another folder with --data",
            file=data,
        )


@contextmanager
def _owned(data: Path) -> Iterator[None]:
    """Create and lock the experiment's folder while the body runs.

    Raises:
        InUse: Another program has locked it.
        RecordingError: The folder cannot be written or locked.
    """
    try:
        data.mkdir(parents=True, exist_ok=True)
        lock = folder_lock(data, what=f"the experiment in {data}")
        lock.take()
    except InUse:
        raise
    except OSError as error:
        raise RecordingError(
            f"cannot write to {data}: {error.strerror}; choose another folder with --data"
        ) from error
    with lock:
        yield


@contextmanager
def _commandable(data: Path, control: Control) -> Iterator[None]:
    """Serve the control socket while the body runs; write its port and token to `control.json`.

    Only the file's owner may read it; it is removed at the end. An emergency stop that another
    program latches on disk is carried out as well, without the socket.
    """
    file, draft, latch = data / CONTROL_FILE, data / f".{CONTROL_FILE}.new", EmergencyLatch(data)

    def look() -> None:
        """Request an emergency stop once one is latched on disk."""
        if not control.stop.latched and (reason := latch.reason) is not None:
            control.stop.request(StopCategory.EMERGENCY, reason)

    watch = repeating(look, every=LOOK_EVERY, name="emergency latch", control=control)
    with watch, ControlServer(control) as server:
        draft.unlink(missing_ok=True)
        handle = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "w", encoding="utf-8") as out:
            json.dump({"port": server.port, "token": server.token}, out)
        draft.replace(file)
        try:
            yield
        finally:
            file.unlink(missing_ok=True)
