# SPDX-License-Identifier: MIT
"""Write a run folder during a run, with non-blocking queues between devices and disk.

One thread writes; a second one flushes to the disk (fsync), so that a slow disk delays neither the
log nor the devices; a third one checks that the folder still exists. After SIGKILL the log lacks
the samples of about the last `FLUSH_EVERY`.
"""

import contextlib
import os
import shutil
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.sample_queue import SampleQueue
from zebro_lab.files.errors import RecordingError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.ros_messages import INFO
from zebro_lab.mcap.stream_views import StreamView
from zebro_lab.recording.place import OpenPlace, sync_files
from zebro_lab.recording.threads import needing_threads
from zebro_lab.runs.folder import LOG_FILE, epoch_ns, new_run_folder
from zebro_lab.runs.manifest import (
    MANIFEST_FILE,
    RECORDING,
    RunManifest,
    manifest_text,
    profile_file,
    software_version,
    write_manifest,
)

FLUSH_EVERY: Final = 0.1
"""Interval at which the queues are written and flushed [s]."""
SYNC_EVERY: Final = 1.0
LIMIT: Final = 100_000
"""Capacity of the queue of one stream: 14 s of a fast load cell [samples]."""
LEAST_FREE: Final = 64 << 20
"""Free space below which a run does not start, or ends [bytes]."""
RESERVE: Final = 1 << 16
"""Space reserved in the run folder for the end record on a full disk [bytes]."""
JOIN_LIMIT: Final = 30.0
"""Timeout for the writer threads to end [s]."""
END_LIMIT: Final = 60.0
"""Timeout for the end of the log and the end record [s]."""
_RESERVE_FILE = ".reserve"


@dataclass(frozen=True)
class RunDescription:
    """Description of a run before it begins.

    Attributes:
        kind: "slip-rig" or "walk".
        label: Name of the run.
        source: "real", "sim:what", "replay:what", or "mixed:" and several.
        material: Leg and ground material.
        operator: Name of the operator.
        constants: Radii of a slip rig [m].
        profiles: Name and TOML text of each device's profile, by its name in the run folder.
        sources: Source of each stream.
        robot: Name of the robot.
        truth: True parameters of simulated devices.
        commit: Commit of this software.
        excluded: Why the run is left out of calibrations until `RunRecorder.judge` changes it;
            empty where it is not left out.
        point: Record of the point of an experiment.
    """

    kind: str
    label: str
    source: str
    material: str = "unknown"
    operator: str = "unknown"
    constants: Mapping[str, float] = field(default_factory=dict)
    profiles: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    robot: str | None = None
    truth: Mapping[str, Any] = field(default_factory=dict)
    commit: str = "unknown"
    excluded: str = ""
    point: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class _Event:
    host_time: float
    text: str
    level: int


class RunRecorder:
    """Writer of a run folder; a context manager.

    Leaving the context writes the end of the log and the end record with its reason, which may be
    an exception. Entering does not wait for the disk: the first files are also flushed by a thread.
    During the run the existence of the folder and the free disk space are checked.

    Args:
        data_dir: Folder of run folders; created when missing.
        description: Description of the run.
        views: Converter of each stream to display messages, by the stream's name.
        limit: Capacity of the queue of each stream [samples].
        least_free: Free space below which a run does not start, or ends [bytes].
        clock: Host time.

    Attributes:
        folder: The run folder; its new path if it was renamed and can be found.
        start: Host time at which the run began [s].
    """

    def __init__(
        self,
        data_dir: Path,
        *,
        description: RunDescription,
        views: Mapping[str, StreamView],
        limit: int = LIMIT,
        least_free: int = LEAST_FREE,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self.folder = Path(data_dir)
        self.start = 0.0
        self._data_dir = Path(data_dir)
        self._description = description
        self._views = views
        self._limit = limit
        self._least_free = least_free
        self._clock = clock
        self._queues = {name: SampleQueue(limit=limit) for name in views}
        self._notes: deque[_Event | tuple[float, str, Counters]] = deque()
        self._counters = dict.fromkeys(views, Counters())
        self._clocks: dict[str, Mapping[str, float]] = {}
        self._failure: str | None = None
        self._failing = threading.Lock()
        self._reason = "completed"
        self._excluded = description.excluded
        self._point = description.point
        self._duration: dict[str, float] = {}
        self._ended: float | None = None
        self._ending = threading.Event()
        self._threads: list[threading.Thread] = []
        self._manifest: RunManifest | None = None
        self._log: LogWriter | None = None
        self._file: IO[bytes] | None = None
        self._place: OpenPlace | None = None

    @property
    def failure(self) -> str | None:
        """Why writing has stopped, or the end is incomplete; None without a failure.

        A failure of a recorder thread appears here within a second: a full or failing disk, a
        folder that was removed or renamed. A program that drives motors must check it.
        """
        return self._failure

    def write(self, stream: str, samples: Sequence[Sample]) -> bool:
        """Queue samples of a stream for writing without blocking.

        Args:
            stream: Name of the stream.
            samples: Its next samples.

        Returns:
            Whether the queue had room; where it had none, the recording fails.
        """
        if self._queues[stream].put(samples):
            return True
        self._fail(f"disk too slow: more than {self._limit} samples of '{stream}' wait")
        return False

    def event(self, text: str, *, level: int = INFO) -> None:
        """Log an event that happens now.

        Args:
            text: Description of the event.
            level: Severity, as in `logging`.
        """
        self._notes.append(_Event(self._clock.now(), text, level))

    def count(self, stream: str, counters: Counters) -> None:
        """Log the counters of a stream.

        Args:
            stream: Name of the stream.
            counters: Samples received, lost, damaged and so on so far.
        """
        self._counters[stream] = counters
        self._notes.append((self._clock.now(), stream, counters))

    def dropped(self, stream: str) -> int:
        """Return the number of samples of a stream dropped because its queue was full."""
        return self._queues[stream].dropped

    def compare_clocks(self, clocks: Mapping[str, Mapping[str, float]]) -> None:
        """Store offset [s], drift [-] and delay [s] of each device's clock for the end record."""
        self._clocks = dict(clocks)

    def count_duration(self, asked: float, *, since: float) -> None:
        """Store the requested duration of the run for the end record.

        Args:
            asked: Requested duration [s].
            since: Host time from which the duration counts [s].
        """
        self._duration = {"asked": asked, "from": since - self.start}

    def end(self, reason: str = "completed") -> None:
        """Set the time and reason of the run's end; the first call counts."""
        self._ended = self._clock.now()
        if self._reason == "completed":
            self._reason = reason

    def judge(self, *, excluded: str, point: Mapping[str, Any]) -> None:
        """Set the verdict on the run, which is stored in the end record atomically.

        Args:
            excluded: Why the run is left out of every calibration; empty where it counts.
            point: Record of the point of an experiment, with whether it was accepted.
        """
        self._excluded, self._point = excluded, point

    def require_space(self) -> None:
        """Check the free disk space.

        Raises:
            RecordingError: It is less than the limit.
        """
        try:
            free = shutil.disk_usage(self._data_dir).free
        except OSError as error:
            raise RecordingError(f"cannot see {self._data_dir}: {error.strerror}") from error
        if free < self._least_free:
            raise RecordingError(
                f"{self._data_dir} has {free / 1e6:.0f} MB free; expected at least "
                f"{self._least_free / 1e6:.0f} MB: make room, or name another folder as --data"
            )

    def __enter__(self) -> Self:
        began = datetime.now(UTC)
        self.start = self._clock.now()
        given = self._description
        self.folder = new_run_folder(
            self._data_dir, kind=given.kind, label=given.label, start=began
        )
        try:
            self.require_space()
            self._begin(began)
            for target in (self._write_on, self._sync_on, self._look_on):
                self._start_thread(target)
        except (RecordingError, OSError) as error:
            self._leave_nothing()
            if isinstance(error, RecordingError):
                raise
            raise RecordingError(f"cannot write {self.folder}: {error.strerror}") from error
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is not None:
            self.end(f"failed: {_one_line(error)}")
        if self._ended is None:
            self.end()
        self._ending.set()
        try:
            finishing = self._start_thread(self._finish)
        except RecordingError:  # no thread any more: then in this one
            self._finish()
            return
        try:  # not in this thread, so that an impatient Ctrl-C costs no end record
            finishing.join(JOIN_LIMIT + END_LIMIT)
        except KeyboardInterrupt:
            finishing.join(JOIN_LIMIT + END_LIMIT)
            raise
        if finishing.is_alive():
            self._fail(f"the disk did not take the end of the run within {END_LIMIT:g} s")

    def _start_thread(self, target: Callable[[], None]) -> threading.Thread:
        thread = threading.Thread(target=target, daemon=True, name="recorder")
        with needing_threads():
            thread.start()
        self._threads.append(thread)
        return thread

    def _leave_nothing(self) -> None:
        self._ending.set()
        for thread in self._threads:
            thread.join(JOIN_LIMIT)
        if self._file is not None:
            self._file.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _fail(self, why: str) -> None:
        """Store why writing has stopped; the first reason counts."""
        with self._failing:
            if self._failure is None:
                self._failure = why

    def _begin(self, began: datetime) -> None:
        given = self._description
        texts = {name: text for name, (_, text) in given.profiles.items()}
        for name, text in texts.items():
            profile_file(self.folder, name).parent.mkdir(exist_ok=True)
            profile_file(self.folder, name).write_text(text, encoding="utf-8", newline="")
        (self.folder / _RESERVE_FILE).write_bytes(os.urandom(RESERVE))
        self._file = (self.folder / LOG_FILE).open("xb")
        self._place = OpenPlace(self.folder / LOG_FILE, self._file)
        attachments = {f"profiles/{name}.toml": text for name, text in texts.items()}
        self._log = LogWriter(
            self._file, views=self._views, attachments=attachments, start=self.start,
            start_ns=epoch_ns(began),
        )  # fmt: skip
        self._log.event(self.start, f"recording '{given.label}' began, source {given.source}")
        self._log.flush()
        self._manifest = RunManifest(
            kind=given.kind,
            label=given.label,
            material=given.material,
            operator=given.operator,
            source=given.source,
            start=began.isoformat(),
            stop=None,
            exit_status=RECORDING,
            software=software_version(given.commit),
            constants=given.constants,
            streams={},
            profiles={name: profile for name, (profile, _) in given.profiles.items()},
            sources=given.sources,
            robot=given.robot,
            truth=given.truth,
            excluded=_exclusion(self._excluded),
            point=self._point,
        )
        draft = self.folder / f".{MANIFEST_FILE}.part"
        draft.write_text(manifest_text(self._manifest), encoding="utf-8", newline="")
        draft.replace(self.folder / MANIFEST_FILE)

    def _write_on(self) -> None:
        try:
            while not self._ending.wait(FLUSH_EVERY):
                self._drain()
                self._flush()
            self._drain()
            self._flush()
        except BaseException as error:  # noqa: BLE001, RUF100 - kept for the owner, who ends the run
            self._fail(f"{self.folder / LOG_FILE}: {_one_line(error)}")

    def _look_on(self) -> None:
        """Check folder and disk space periodically, in a thread that a slow disk does not delay."""
        seen = self._clock.now()
        try:
            while not self._ending.wait(FLUSH_EVERY):
                self._require_place()
                if self._clock.now() - seen >= SYNC_EVERY:
                    seen = self._clock.now()
                    self.require_space()
            self._require_place()
        except RecordingError as error:
            self._fail(str(error))
        except BaseException as error:  # noqa: BLE001, RUF100 - kept for the owner, who ends the run
            self._fail(f"{self.folder}: {_one_line(error)}")

    def _require_place(self) -> None:
        problem = None if self._place is None else self._place.problem()
        if problem is not None:
            raise RecordingError(f"{problem} while recording")

    def _sync_on(self) -> None:
        try:
            profiles = [profile_file(self.folder, name) for name in self._description.profiles]
            sync_files([self.folder / MANIFEST_FILE, *profiles])
            while not self._ending.wait(SYNC_EVERY):
                if self._file is not None:
                    os.fsync(self._file.fileno())
        except BaseException as error:  # noqa: BLE001, RUF100 - kept for the owner, who ends the run
            self._fail(f"the disk does not keep {self.folder}: {_one_line(error)}")

    def _drain(self) -> None:
        if self._log is None:
            return
        for name, queue in self._queues.items():
            samples = queue.take()
            if samples:
                self._log.write(name, samples)
        while self._notes:
            note = self._notes.popleft()
            if isinstance(note, _Event):
                self._log.event(note.host_time, note.text, level=note.level)
            else:
                at, stream, counters = note
                self._log.count(at, stream, counters, dropped=self.dropped(stream))

    def _flush(self) -> None:
        if self._log is not None:
            self._log.flush()

    def _finish(self) -> None:
        """Close the log and write the end record; a failure becomes its reason."""
        before = [thread for thread in self._threads if thread is not threading.current_thread()]
        for thread in before:
            thread.join(JOIN_LIMIT)
        whole = False
        try:
            self._require_taken(before)
            with contextlib.suppress(FileNotFoundError):
                (self.folder / _RESERVE_FILE).unlink()
            whole = self._failure is None and self._close_log()
        except BaseException as error:  # noqa: BLE001, RUF100 - kept for the owner
            self._fail(f"{self.folder / LOG_FILE}: {_one_line(error)}")
        try:
            self._write_end_record(whole=whole)
        except BaseException as error:  # noqa: BLE001, RUF100 - kept for the owner
            self._fail(f"{self.folder}: its end record cannot be written: {_one_line(error)}")
        finally:
            if self._file is not None and not any(thread.is_alive() for thread in before):
                with contextlib.suppress(OSError):
                    self._file.close()

    def _require_taken(self, threads: Sequence[threading.Thread]) -> None:
        if any(thread.is_alive() for thread in threads):
            raise RecordingError(f"the disk took nothing for {JOIN_LIMIT:g} s")

    def _close_log(self) -> bool:
        if self._log is None or self._file is None:
            return False
        now = self._clock.now()
        for name, counters in self._counters.items():
            self._log.count(now, name, counters, dropped=self.dropped(name))
        self._log.event(now, f"recording ended: {self._reason}")
        self._log.finish()
        self._file.flush()
        os.fsync(self._file.fileno())
        return True

    def _write_end_record(self, *, whole: bool) -> None:
        if self._manifest is None or self._log is None or self._place is None:
            return
        folder = self._place.folder()
        if folder is None:
            raise RecordingError("the folder is gone")
        self.folder = folder
        ended = self._clock.now() if self._ended is None else self._ended
        lasted = timedelta(seconds=ended - self.start)
        failed = self._failure is not None and not self._reason.startswith("failed: ")
        if self._point and not whole:  # samples may be missing: the point is not finished
            self._point = {**self._point, "accepted": False}
            self._excluded = self._excluded or self._failure or self._reason
        self._manifest = replace(
            self._manifest,
            stop=(datetime.fromisoformat(self._manifest.start) + lasted).isoformat(),
            exit_status=f"failed: {self._failure}" if failed else self._reason,
            streams=self._log.written,
            log_sha256=file_hash(folder / LOG_FILE) if whole else None,
            counters={
                name: asdict(counters) | {"dropped": self.dropped(name)}
                for name, counters in self._counters.items()
            },
            clocks=self._clocks,
            excluded=_exclusion(self._excluded),
            point=self._point,
            duration=self._duration,
        )
        write_manifest(folder, self._manifest)


def _exclusion(why: str) -> Mapping[str, str] | None:
    return {"why": why} if why else None


def _one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())
