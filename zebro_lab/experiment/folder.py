# SPDX-License-Identifier: MIT
"""Store an experiment: one run folder for each attempt at a point, and the journal.

A separate thread writes, so that the disk never blocks the thread that feeds the watchdogs. It also
checks the free disk space and that the folder still exists.
"""

import queue
import threading
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Stream
from rig.experiment.readings import Batch, Readings
from rig.experiment.sink import RunStart, SinkFailed
from rig.experiment.verdict import PointVerdict
from zebro_lab.experiment.journal import EMERGENCY, JournalWriter
from zebro_lab.experiment.latch import EmergencyLatch
from zebro_lab.experiment.points import UNJUDGED, point_record, why_excluded
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.recording.run_files import identity, require_space
from zebro_lab.runs.manifest import RunManifest

MOST_WAITING: Final = 20_000
"""Capacity of the queue of write jobs: more than a minute of an experiment."""
JOIN_LIMIT: Final = 30.0
"""Timeout of the writing thread at the end of an experiment [s]."""
DISK_PERIOD: Final = 0.1
"""Interval between checks of free disk space and folder [s]."""
LONGEST_JOB: Final = 10.0
"""Timeout of one write, after which the disk counts as failed [s]."""


@dataclass(frozen=True)
class _Job:
    """Queued write job: a function to call in the writing thread, and the event set at its end."""

    write: Callable[[], None]
    done: threading.Event = field(default_factory=threading.Event)


class ExperimentFolder:
    """Recorder of an experiment's runs; implements the protocol `RunSink`; a context manager.

    Leaving it waits for the queued writes, at most `JOIN_LIMIT`.

    Args:
        data: Folder of the experiment; created when missing.
        plan: Fingerprint of the plan.
        manifest: Manifest entries common to all runs.
        profiles: Name and text of the rig's profile, by its role in a run folder (`rig`).
        streams: Streams of the rig, whose counters each run has from its opening on.
        clock: Clock of host time.
        in_step: Wait until a run's start and end are on disk, for a twin with simulated time.

    Raises:
        SinkFailed: The thread cannot be started on entering; or on leaving without an exception,
            something could not be written. In between, each method that refers to `RunSink` raises
            it after a failure of the writing thread, or where the queue is full.
    """

    def __init__(
        self,
        data: Path,
        *,
        manifest: RunManifest,
        profiles: Mapping[str, tuple[str, str]],
        streams: Collection[Stream] = (),
        plan: str = "",
        clock: Clock = SYSTEM_CLOCK,
        in_step: bool = False,
    ) -> None:
        self._given, self._data = data, data.resolve()  # should a link on the way be turned
        self._plan = plan
        self._manifest = manifest
        self._profiles = profiles
        self._streams = streams
        self._opened: dict[Stream, Counters] = {}
        self._written: Mapping[str, Counters] = {}
        self._clock = clock
        self._in_step = in_step
        self._journal = JournalWriter(self._data)
        self._latch = EmergencyLatch(self._data)
        self._jobs: queue.Queue[_Job] = queue.Queue(MOST_WAITING)
        self._ending = threading.Event()
        self._failure: str | None = None
        self._least_room = 0.0
        self._checked_at = 0.0
        self._busy_since: float | None = None
        self._identity: tuple[int, int] | None = None
        self._recorder: RunRecorder | None = None
        self._start: RunStart | None = None
        self._thread = threading.Thread(target=self._work, daemon=True, name="writer")

    def open_run(self, start: RunStart) -> None:
        """Queue the opening of a run folder, excluded until its end; see `RunSink.open_run`.

        The zero is stored as the run's constants `zero_normal` and `zero_traction` [N].
        """
        label = start.point.label + (f" attempt {start.attempt}" if start.attempt > 1 else "")
        zero = {"zero_normal": start.zero.normal, "zero_traction": start.zero.traction}
        manifest = replace(
            self._manifest, label=label, constants={**self._manifest.constants, **zero},
            excluded={"why": UNJUDGED}, point=point_record(self._plan, start, accepted=False),
        )  # fmt: skip

        def open_now() -> None:
            """Open the run folder; called in the writing thread."""
            self._recorder = self._enter(manifest)
            self._start = start
            if start.guards_off:
                self._recorder.event(f"guards off: {start.guards_off}")

        self._require_working()
        self._opened = {stream: stream.counters for stream in self._streams}
        self._put(open_now, wait=True)

    def write(self, readings: Readings, batch: Batch) -> None:
        """Queue the raw samples of a batch for the run's log, and what is counted in between.

        The `readings`, which follow from the raw samples, are ignored; see `RunSink.write`.
        """
        del readings
        raw = batch.raw
        self._written = counted = self._counted()

        def write_now() -> None:
            """Write the samples to the open run, if any; called in the writing thread."""
            if self._recorder is not None:
                for stream, samples in raw.items():
                    if samples:
                        self._recorder.write(stream, samples)
                for stream, counters in counted.items():
                    self._recorder.count(stream, counters)

        self._require_working()
        self._put(write_now)

    def close_run(self, verdict: PointVerdict | None, *, reason: str) -> None:
        """Queue the closing of the run folder, also after a failure; see `RunSink.close_run`.

        The folder of a rejected or aborted run is kept, and excluded from calibrations.

        Args:
            verdict: Verdict on the point; None where the run was aborted.
            reason: `completed`, or why the run ended.

        Raises:
            SinkFailed: The queue is full; in simulated time also if writing failed.
        """
        # The guards have looked on after the last sample of a point that is judged.
        counted = self._counted() if verdict is None else self._written
        self._put(lambda: self._close_now(verdict, reason, counted), wait=True)

    def event(self, kind: str, text: str) -> None:
        """Queue an event for the journal and the open run's log, if any, also after a failure.

        Args:
            kind: Kind of event, such as `note`.
            text: Description; `completed` as an `end` gives way to a failure of writing.

        Raises:
            SinkFailed: The queue is full; or, the event queued, the writing thread has failed
                before and `kind` is not `end`.
        """

        def note() -> None:
            """Write the event; called in the writing thread."""
            if self._recorder is not None:
                self._recorder.event(f"{kind}: {text}")
            lost = kind == "end" and text == "completed" and self._failure
            self._journal.append(kind, lost or text)

        self._put(note)
        if kind != "end":
            self._require_working()

    def require_room(self, least: float) -> None:
        """Set the least free disk space, and raise SinkFailed where the writer has failed.

        Too little space is found by the writer, so that a later call raises.

        Args:
            least: Least free space [bytes]; checked by the writing thread from now on.
        """
        self._least_room = least
        self._require_working()

    def latch(self, reason: str) -> None:
        """Latch an emergency stop on disk at once, without the queue; see `RunSink.latch`.

        An error of the file system is not raised here, but by the next other call, as SinkFailed.
        """
        try:
            self._latch.latch(f"{EMERGENCY}: {reason}")
        except OSError as error:
            self._fail(error)

    def __enter__(self) -> Self:
        self._identity = identity(self._data.stat())
        self._journal.__enter__()
        try:
            self._thread.start()
        except RuntimeError as error:
            raise SinkFailed(f"the thread that writes the data cannot start: {error}") from error
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._ending.set()
        self._thread.join(JOIN_LIMIT)
        if self._thread.is_alive():
            self._failure = f"the disk of {self._data} did not answer for {JOIN_LIMIT:g} s"
        else:  # the thread may have ended early: the remaining jobs are done here
            while not self._jobs.empty():
                self._do(self._jobs.get_nowait())
        self._journal.__exit__(kind, error, trace)
        if error is None:
            self._require_working()

    def _enter(self, manifest: RunManifest) -> RunRecorder:
        """Open a run folder, with `again N` in its label where the folder's name is in use."""
        again = 1
        while True:
            recorder = RunRecorder(
                self._data, manifest=manifest, profiles=self._profiles, clock=self._clock
            )
            try:
                return recorder.__enter__()
            except AlreadyExists:
                again += 1
                label = f"{manifest.label.partition(' again')[0]} again {again}"
                manifest = replace(manifest, label=label)

    def _counted(self) -> Mapping[str, Counters]:
        """Return what each stream has counted since the run was opened; in the acquiring thread."""
        return {stream.name: stream.counters.since(then) for stream, then in self._opened.items()}

    def _close_now(
        self, verdict: PointVerdict | None, reason: str, counted: Mapping[str, Counters]
    ) -> None:
        """Write the verdict with the end record, and the journal's entry of the point.

        A point whose recorder failed, also while it closed, is not accepted; the failure is stored.
        Nothing is written if no run is open.
        """
        recorder, self._recorder = self._recorder, None
        if recorder is None or self._start is None:
            return
        for stream, counters in counted.items():
            recorder.count(stream, counters)
        start, point = self._start, self._start.point
        kept = recorder.failure is None
        accepted = verdict is not None and verdict.accepted and kept
        why = "" if accepted else why_excluded(verdict, reason, recorder.failure)
        # Atomic: the end record holds both the verdict and whether the run counts.
        recorder.judge(excluded=why, point=point_record(self._plan, start, accepted=accepted))
        recorder.end(reason)
        recorder.__exit__(None, None, None)
        if recorder.failure is not None:  # the end record also excludes the run
            accepted, why = False, recorder.failure
            self._fail(SinkFailed(why))
        judged: dict[str, Any] = {} if verdict is None else {
            "slip": verdict.slip, "friction": verdict.friction, "normal": verdict.normal_force
        }  # fmt: skip
        self._journal.append(
            "point", why or "accepted", number=point.number, accepted=accepted,
            attempt=start.attempt, folder=recorder.folder.name, label=point.label, **judged,
        )  # fmt: skip

    def _put(self, write: Callable[[], None], *, wait: bool = False) -> None:
        """Queue a job, or raise SinkFailed; in simulated time, `wait` returns once it is done."""
        job = _Job(write)
        try:
            self._jobs.put_nowait(job)
        except queue.Full:
            raise SinkFailed(
                f"the disk of {self._data} is too slow: {MOST_WAITING} write jobs are waiting"
            ) from None
        if wait and self._in_step:
            while not job.done.wait(DISK_PERIOD):
                self._require_working()
            self._require_working()

    def _require_working(self) -> None:
        """Raise SinkFailed if the thread has failed, ended, or hangs in one job."""
        started = self._thread.ident is not None
        if started and not (self._ending.is_set() or self._thread.is_alive()):
            self._failure = self._failure or "the thread that writes has ended unexpectedly"
        busy = self._busy_since
        if busy is not None and time.monotonic() - busy > LONGEST_JOB:
            self._failure = f"the disk of {self._data} has not answered for {LONGEST_JOB:g} s"
        if self._failure is not None:
            raise SinkFailed(f"the data cannot be saved: {self._failure}")

    def _fail(self, error: BaseException) -> None:
        """Store the first failure as text, for the acquiring thread, which then stops the rig."""
        if self._failure is None:
            kind = "" if isinstance(error, SinkFailed) else f"{type(error).__name__}: "
            self._failure = " ".join(f"{kind}{error}".split())

    def _work(self) -> None:
        """Carry out queued jobs until the end, also those behind a job that has failed."""
        while not (self._ending.is_set() and self._jobs.empty()):
            try:
                job = self._jobs.get(timeout=DISK_PERIOD)
            except queue.Empty:
                job = _Job(lambda: None)
            self._do(job)

    def _do(self, job: _Job) -> None:
        """Carry out a job and check the disk; store any failure."""
        self._busy_since = time.monotonic()
        try:
            job.write()
            self._check_disk()
        except BaseException as error:  # noqa: BLE001, RUF100 - whatever it is, the rig stops
            self._fail(error)
        finally:
            self._busy_since = None
            job.done.set()

    def _check_disk(self) -> None:
        """Raise where the folder is gone, the recorder failed or the disk is full.

        Nothing is checked within `DISK_PERIOD` of the last check.
        """
        now = time.monotonic()
        if now - self._checked_at < DISK_PERIOD:
            return
        self._checked_at = now
        if not self._given.exists() or identity(self._given.stat()) != self._identity:
            raise SinkFailed(f"the folder {self._given} was removed or replaced")
        if self._recorder is not None and self._recorder.failure is not None:
            raise SinkFailed(self._recorder.failure)
        require_space(self._data, self._least_room)
