# SPDX-License-Identifier: MIT
"""Keeps an experiment: a run folder a point, and the journal.

A thread of its own writes, so that no disk ever holds up the thread that feeds the watchdogs.
"""

import queue
import shutil
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.experiment.bench import Batch, Readings
from rig.experiment.sink import RunStart, SinkFailed
from rig.experiment.verdict import Verdict
from zebro_lab.errors import AlreadyExists, ZebroLabError
from zebro_lab.experiment_journal import JournalWriter
from zebro_lab.recorder import RunDescription, RunRecorder
from zebro_lab.run_folder import exclude_run
from zebro_lab.stream_views import View

MOST_WAITING: Final = 20_000
"""Jobs that may wait for the disk: more than a minute of an experiment."""
JOIN_LIMIT: Final = 30.0


class ExperimentFolder:
    """Satisfies `rig.experiment.sink.Sink`; a context manager.

    Args:
        data: Folder of the experiment.
        description: What all its runs have in common.
        views: Makes new views of the streams for a run's log.
        clock: Host time.
        in_step: Wait for the disk at both ends of every run: for a twin whose time passes at once.
    """

    def __init__(
        self,
        data: Path,
        *,
        description: RunDescription,
        views: Callable[[], Mapping[str, View]],
        clock: Clock = SYSTEM_CLOCK,
        in_step: bool = False,
    ) -> None:
        self._data = data
        self._description = description
        self._views = views
        self._clock = clock
        self._in_step = in_step
        self._journal = JournalWriter(data)
        self._jobs: queue.Queue[Callable[[], None] | None] = queue.Queue(MOST_WAITING)
        self._failure: str | None = None
        self._recorder: RunRecorder | None = None
        self._start: RunStart | None = None
        self._thread = threading.Thread(target=self._work, daemon=True, name="experiment")

    def open_run(self, start: RunStart) -> None:
        """Begin a run folder; see `Sink.open_run`."""
        label = start.point.label + (f" attempt {start.attempt}" if start.attempt > 1 else "")
        zero = {"zero_normal": start.zero.normal, "zero_traction": start.zero.traction}
        common = self._description
        description = replace(common, label=label, constants={**common.constants, **zero})

        def open_now() -> None:
            self._recorder = self._enter(description)
            self._start = start

        self._put(open_now, wait=True)

    def write(self, readings: Readings, batch: Batch) -> None:
        """Keep the raw samples, out of which readings come again; see `Sink.write`."""
        del readings
        raw = batch.raw

        def write_now() -> None:
            if self._recorder is not None:
                for stream, samples in raw.items():
                    if samples:
                        self._recorder.write(stream, samples)
                if self._recorder.failure is not None:
                    self._failure = self._recorder.failure

        self._put(write_now)

    def close_run(self, verdict: Verdict | None, *, reason: str) -> None:
        """End the run folder; what is not good is excluded, and kept; see `Sink.close_run`."""
        self._put(lambda: self._close_now(verdict, reason), wait=True)

    def event(self, kind: str, text: str) -> None:
        """Append to the journal, and to the run's log; see `Sink.event`."""

        def note() -> None:
            if self._recorder is not None:
                self._recorder.event(f"{kind}: {text}")
            self._journal.append(kind, text)

        self._put(note)

    def require_room(self, least: float) -> None:
        """Check the disk; see `Sink.require_room`."""
        self._require_well()
        free = shutil.disk_usage(self._data).free
        if free < least:
            raise SinkFailed(
                f"room for data in {self._data} is {free / 1e6:.0f} MB; its limit is "
                f"{least / 1e6:.0f} MB"
            )

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._jobs.put(None)
        self._thread.join(JOIN_LIMIT)
        if error is None:
            self._require_well()

    def _enter(self, description: RunDescription) -> RunRecorder:
        """Begin a run folder under a name that is free: a point may come again within a second."""
        again = 1
        while True:
            recorder = RunRecorder(
                self._data, description=description, views=self._views(), clock=self._clock
            )
            try:
                return recorder.__enter__()
            except AlreadyExists:
                again += 1
                label = f"{description.label.partition(' again')[0]} again {again}"
                description = replace(description, label=label)

    def _close_now(self, verdict: Verdict | None, reason: str) -> None:
        recorder, self._recorder = self._recorder, None
        if recorder is None or self._start is None:
            return
        accepted = verdict is not None and verdict.accepted
        why = reason if verdict is None else "; ".join(verdict.problems)
        recorder.end(reason)
        recorder.__exit__(None, None, None)
        if not accepted:
            exclude_run(recorder.folder, why=why)
        point = self._start.point
        judged: dict[str, Any] = {} if verdict is None else {
            "slip": verdict.slip, "friction": verdict.friction, "normal": verdict.normal_force
        }  # fmt: skip
        self._journal.append(
            "point", why or "accepted", number=point.number, accepted=accepted,
            attempt=self._start.attempt, folder=recorder.folder.name, label=point.label, **judged,
        )  # fmt: skip

    def _put(self, job: Callable[[], None], *, wait: bool = False) -> None:
        self._require_well()
        try:
            self._jobs.put_nowait(job)
        except queue.Full:
            raise SinkFailed(
                f"the disk of {self._data} is too slow: {MOST_WAITING} writes wait"
            ) from None
        if wait and self._in_step:
            self._jobs.join()
            self._require_well()

    def _require_well(self) -> None:
        if self._failure is not None:
            raise SinkFailed(f"data cannot be kept: {self._failure}")

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            try:
                job()
            except (OSError, ZebroLabError) as error:
                self._failure = f"{type(error).__name__}: {error}"
            finally:
                self._jobs.task_done()
