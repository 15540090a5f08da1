# SPDX-License-Identifier: MIT
"""Write a run folder during a run, with non-blocking queues between devices and disk.

One thread writes; a second one flushes to the disk (fsync), so that a slow disk delays neither the
log nor the devices; a third one checks that the folder still exists. After SIGKILL the log lacks
the samples of about the last `FLUSH_EVERY`.
"""

import shutil
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.sample_queue import SampleQueue
from zebro_lab.files.errors import RecordingError
from zebro_lab.mcap.log_writer import INFO, LogWriter
from zebro_lab.recording.run_files import RunFiles, needing_threads, require_space
from zebro_lab.runs.folder import LOG_FILE, new_run_folder, removing_new_folders
from zebro_lab.runs.manifest import RunManifest

FLUSH_EVERY: Final = 0.1
"""Interval at which the queues are written and flushed [s]."""
COUNT_EVERY: Final = 1.0
"""Interval at which counters are logged, and rates computed [s]."""
SYNC_EVERY: Final = 1.0
"""Interval of flushing the log to the disk (fsync) and of checks of free space [s]."""
LIMIT: Final = 100_000
"""Capacity of the queue of one stream: 14 s of a fast load cell [samples]."""
LEAST_FREE: Final = 64 << 20
"""Free space below which a run does not start, or ends [bytes]."""
JOIN_LIMIT: Final = 30.0
"""Timeout for each of the writer threads to end [s]."""
END_LIMIT: Final = 60.0
"""Timeout for the end of the log and the end record [s]."""


class RunRecorder:
    """Writer of a run folder; a context manager.

    Leaving the context writes the end of the log and the end record with its reason, which may be
    an exception. Entering does not wait for the disk: the first files are also flushed by a thread.
    During the run the existence of the folder and the free disk space are checked.

    Args:
        data_dir: Folder of run folders; created when missing.
        manifest: Manifest entries known before the run begins.
        profiles: Name and TOML text of each device's profile, by its name in the run folder.
        limit: Capacity of the queue of each stream [samples].
        least_free: Free space below which a run does not start, or ends [bytes].
        clock: Clock of host time.

    Attributes:
        folder: The run folder; after the end its new path if it was renamed and can be found.
            Before the run `data_dir`.
        start: Host time at which the run began [s]; 0 before.

    Raises:
        RecordingError: On entering: too little space, or a file or thread fails; nothing is left.
        AlreadyExists: On entering: a run of this kind, start (to the second) and label exists.
        RigError: On entering: a profile is invalid.
    """

    def __init__(
        self,
        data_dir: Path,
        *,
        manifest: RunManifest,
        profiles: Mapping[str, tuple[str, str]],
        limit: int = LIMIT,
        least_free: int = LEAST_FREE,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self.folder = Path(data_dir)
        self.start = 0.0
        self._data_dir = Path(data_dir)
        names = {stream: name for stream, (name, _) in profiles.items()}
        self._manifest = replace(manifest, profiles=names)
        self._texts = {stream: text for stream, (_, text) in profiles.items()}
        self._limit = limit
        self._least_free = least_free
        self._clock = clock
        self._queues: dict[str, SampleQueue] = {}
        self._notes: deque[Callable[[LogWriter], None]] = deque()
        self._counters: dict[str, Counters] = {}
        self._counted: dict[str, float] = {}
        self._failure: str | None = None
        self._failing = threading.Lock()
        self._reason = "completed"
        self._ended: float | None = None
        self._ending = threading.Event()
        self._threads: list[threading.Thread] = []
        self._files: RunFiles | None = None

    @property
    def failure(self) -> str | None:
        """First reason why samples, or the end of the run, were not written; None without one.

        A failure of a recorder thread appears here within a second: a full or failing disk, a
        folder that was removed or renamed. A program that drives motors must check it.
        """
        return self._failure

    def write(self, stream: str, samples: Sequence[Sample]) -> bool:
        """Queue samples of a stream for writing without blocking.

        Args:
            stream: Name of the stream.
            samples: Next samples of the stream.

        Returns:
            True if the queue had room; False if not: samples are dropped, `failure` is set.
        """
        if self._queues[stream].put(samples):
            return True
        self._fail(f"disk too slow: more than {self._limit} samples of '{stream}' wait for writing")
        return False

    def event(self, text: str, *, level: int = INFO) -> None:
        """Queue an event of a level, such as `WARNING`, with the present time for the log."""
        now = self._clock.now()
        self._notes.append(lambda log: log.event(now, text, level=level))

    def count(self, stream: str, counters: Counters) -> None:
        """Store the counters of a stream for the end record, and queue them for the log.

        They are queued every `COUNT_EVERY`; those of the run's end are logged in any case.
        """
        now = self._clock.now()
        self._counters[stream] = counters
        if now - self._counted.get(stream, self.start) >= COUNT_EVERY:
            self._counted[stream] = now
            dropped = self.dropped(stream)
            self._notes.append(lambda log: log.count(now, stream, counters, dropped=dropped))

    def dropped(self, stream: str) -> int:
        """Return the number of samples of a stream dropped so far because its queue was full."""
        return self._queues[stream].dropped

    def compare_clocks(self, clocks: Mapping[str, Mapping[str, float]]) -> None:
        """Store `RunManifest.clocks`, the devices' clocks by stream, for the end record."""
        self._manifest = replace(self._manifest, clocks=clocks)

    def count_duration(self, asked: float, *, since: float) -> None:
        """Store the requested duration of the run for the end record.

        Args:
            asked: Requested duration of the run [s].
            since: Host time from which the duration counts [s].
        """
        duration = {"asked": asked, "from": since - self.start}
        self._manifest = replace(self._manifest, duration=duration)

    def end(self, reason: str = "completed") -> None:
        """Set the run's end to now unless it is set; replace its reason only if `completed`."""
        if self._ended is None:
            self._ended = self._clock.now()
        if self._reason == "completed":
            self._reason = reason

    def judge(self, *, excluded: str, point: Mapping[str, Any]) -> None:
        """Store the verdict on the run for the end record, which is written atomically.

        Args:
            excluded: Why the run is left out of every calibration; empty for an included run.
            point: Entry `point` of the end record; see `experiment.points.point_record`.
        """
        why = {"why": excluded} if excluded else None
        self._manifest = replace(self._manifest, excluded=why, point=point)

    def __enter__(self) -> Self:
        began = datetime.now(UTC)
        self.start = self._clock.now()
        self._manifest = given = replace(self._manifest, start=began.isoformat())
        with removing_new_folders(self._data_dir):
            self.folder = new_run_folder(
                self._data_dir, kind=given.kind, label=given.label, start=began
            )
            try:
                require_space(self._data_dir, self._least_free)
                self._files = RunFiles(self.folder, given, profiles=self._texts, start=self.start)
                for name in self._files.streams:
                    self._queues[name] = SampleQueue(limit=self._limit)
                    self._counters[name] = Counters()
                for task in (self._write_loop, self._sync_loop, self._check_loop):
                    self._start_thread(task, self._files)
            except BaseException as error:
                self._undo()
                if isinstance(error, OSError) and not isinstance(error, RecordingError):
                    raise RecordingError(f"cannot write {self.folder}: {error.strerror}") from error
                raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end("completed" if error is None else f"failed: {_one_line(error)}")
        self._ending.set()
        if self._files is None:
            return
        try:
            finishing = self._start_thread(self._finish, self._files)
        except RecordingError:  # no thread any more: then in this one
            self._finish(self._files)
            return
        try:  # not in this thread, so that an impatient Ctrl-C costs no end record
            finishing.join(JOIN_LIMIT + END_LIMIT)
        except KeyboardInterrupt:
            finishing.join(JOIN_LIMIT + END_LIMIT)
            raise
        if finishing.is_alive():
            self._fail(f"the run's end was not written within {JOIN_LIMIT + END_LIMIT:g} s")

    def _start_thread(self, task: Callable[[RunFiles], None], files: RunFiles) -> threading.Thread:
        """Start `task(files)` in a daemon thread; RecordingError if it cannot start."""
        thread = threading.Thread(target=task, args=(files,), daemon=True, name="recorder")
        with needing_threads():
            thread.start()
        self._threads.append(thread)
        return thread

    def _undo(self) -> None:
        """End the threads and remove the run folder, after a failure to begin."""
        self._ending.set()
        for thread in self._threads:
            thread.join(JOIN_LIMIT)
        if self._files is not None:
            self._files.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _fail(self, why: str) -> None:
        """Store why something is not written as `failure`, unless one is stored already."""
        with self._failing:
            if self._failure is None:
                self._failure = why

    @contextmanager
    def _storing_failure(self, where: object) -> Iterator[None]:
        """Store any exception of the body as `failure`, behind `where` if not a RecordingError."""
        try:
            yield
        except RecordingError as error:
            self._fail(str(error))
        except BaseException as error:  # noqa: BLE001, RUF100 - the owner reads it and ends the run
            self._fail(f"{where}: {_one_line(error)}")

    def _write_loop(self, files: RunFiles) -> None:
        """Write and flush what is queued each `FLUSH_EVERY`, and once more at the end."""
        with self._storing_failure(files.folder / LOG_FILE):
            while not self._ending.wait(FLUSH_EVERY):
                self._drain(files.log)
            self._drain(files.log)

    def _check_loop(self, files: RunFiles) -> None:
        """Check folder, each `FLUSH_EVERY`, and free space, each `SYNC_EVERY`; store a failure."""
        seen = self._clock.now()
        with self._storing_failure(files.folder):
            while not self._ending.wait(FLUSH_EVERY):
                files.require_place()
                if self._clock.now() - seen >= SYNC_EVERY:
                    seen = self._clock.now()
                    require_space(self._data_dir, self._least_free)
            files.require_place()

    def _sync_loop(self, files: RunFiles) -> None:
        """Flush the first files to the disk (fsync), then the log each `SYNC_EVERY`."""
        with self._storing_failure(f"flushing {files.folder} to the disk failed"):
            files.sync_first()
            while not self._ending.wait(SYNC_EVERY):
                files.sync_log()

    def _drain(self, log: LogWriter) -> None:
        """Write all queued samples, events and counters to the log, and flush the log."""
        while self._notes:  # they are older than the last of the samples
            self._notes.popleft()(log)
        for name, queue in self._queues.items():
            samples = queue.take()
            if samples:
                log.write(name, samples)
        log.flush()

    def _finish(self, files: RunFiles) -> None:
        """Join the writers, end the log if nothing failed, write the end record; store failures."""
        before = [thread for thread in self._threads if thread is not threading.current_thread()]
        for thread in before:
            thread.join(JOIN_LIMIT)
        whole = False
        with self._storing_failure(files.folder / LOG_FILE):
            if any(thread.is_alive() for thread in before):
                raise RecordingError(f"a write to the disk did not end within {JOIN_LIMIT:g} s")
            files.free_reserve()
            if self._failure is None:
                self._finish_log(files)
                whole = True
        with self._storing_failure(f"{files.folder}: run.json cannot be completed"):
            files.write_end(self._end_record(whole=whole), whole=whole)
        self.folder = files.folder
        if not any(thread.is_alive() for thread in before):
            files.close()

    def _finish_log(self, files: RunFiles) -> None:
        """Write last counters, the reason of the end, and the log's index; flush it to the disk."""
        now = self._clock.now()
        for name, counters in self._counters.items():
            files.log.count(now, name, counters, dropped=self.dropped(name))
        files.log.event(now, f"recording ended: {self._reason}")
        files.finish_log()

    def _end_record(self, *, whole: bool) -> RunManifest:
        """Return the manifest of the ended run.

        Args:
            whole: Whether the log is complete; else, of an experiment, the point is not accepted
                and the run is excluded.
        """
        ended = self._clock.now() if self._ended is None else self._ended
        stop = self._manifest.began + timedelta(seconds=ended - self.start)
        failed = self._failure is not None and not self._reason.startswith("failed: ")
        excluded, point = self._manifest.excluded, self._manifest.point
        if point and not whole:
            point = {**point, "accepted": False}
            excluded = excluded or {"why": self._failure or self._reason}
        return replace(
            self._manifest,
            stop=stop.isoformat(),
            exit_status=f"failed: {self._failure}" if failed else self._reason,
            counters={
                name: asdict(counters) | {"dropped": self.dropped(name)}
                for name, counters in self._counters.items()
            },
            excluded=excluded,
            point=point,
        )


def _one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())
