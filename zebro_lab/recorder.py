# SPDX-License-Identifier: MIT
"""Writes a run folder while the run happens; whoever hands samples over never waits.

A thread of its own writes; another one lets the disk catch up, so that a slow disk delays neither
the log nor the devices. After SIGKILL the log lacks what came within about `FLUSH_EVERY`.
"""

import contextlib
import os
import shutil
import threading
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from zebro_lab.atomic import atomic_write_text
from zebro_lab.errors import RecordingError
from zebro_lab.log_writer import LogWriter
from zebro_lab.provenance import file_hash
from zebro_lab.ros_messages import INFO
from zebro_lab.run_folder import LOG_FILE, epoch_ns, new_run_folder, profile_file
from zebro_lab.run_manifest import RECORDING, RunManifest, software_version, write_manifest
from zebro_lab.sample_queue import SampleQueue
from zebro_lab.stream_views import View

FLUSH_EVERY: Final = 0.1
"""Pause between two looks at the queues, each of which ends on the disk [s]."""
SYNC_EVERY: Final = 1.0
LIMIT: Final = 100_000
"""Samples of one stream that may wait for the disk: 14 s of a fast load cell."""
LEAST_FREE: Final = 64 << 20
"""Free space below which a run is not begun, and ends [bytes]."""
RESERVE: Final = 1 << 16
"""Kept in the run folder, so that a full disk still takes the end record [bytes]."""
JOIN_LIMIT: Final = 30.0
_RESERVE_FILE = ".reserve"


@dataclass(frozen=True)
class RunDescription:
    """What is known of a run before it begins.

    Attributes:
        kind: "slip-rig" or "walk".
        label: Name of the run.
        source: "real", "sim:what", "replay:what", or "mixed:" and several.
        material: Leg and ground material.
        operator: Who runs it.
        constants: Radii of a slip rig [m].
        profiles: Name and TOML text of each device's profile, by the name it is kept under.
        sources: Source of each stream.
        robot: Name of the robot.
        truth: What simulated devices know to be true.
        commit: Commit of this software.
        excluded: Why the run is left out of calibrations until `RunRecorder.judge` says otherwise;
            empty where it is not.
        point: Which point of an experiment it is.
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
    """A run folder that is being written: a context manager.

    Leaving it writes the end of the log and the end record, with the reason; an exception is one.

    Args:
        data_dir: Folder of run folders; made when missing.
        description: What is known before.
        views: How each stream shows in the log, by its name.
        limit: Most samples of a stream that may wait to be written.
        least_free: Free space below which a run is not begun, and ends [bytes].
        clock: Host time.

    Attributes:
        folder: The run folder.
        start: Host time at which the run began [s].
    """

    def __init__(
        self,
        data_dir: Path,
        *,
        description: RunDescription,
        views: Mapping[str, View],
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
        self._reason = "completed"
        self._excluded = description.excluded
        self._point = description.point
        self._ending = threading.Event()
        self._threads: list[threading.Thread] = []
        self._manifest: RunManifest | None = None
        self._log: LogWriter | None = None
        self._file: IO[bytes] | None = None

    @property
    def failure(self) -> str | None:
        """Why nothing is written any more; None while all is well."""
        return self._failure

    def write(self, stream: str, samples: Sequence[Sample]) -> bool:
        """Hand samples of a stream over; tell whether there was room. Never waits."""
        if self._queues[stream].put(samples):
            return True
        if self._failure is None:
            self._failure = f"disk too slow: more than {self._limit} samples of '{stream}' wait"
        return False

    def event(self, text: str, *, level: int = INFO) -> None:
        """Write down something that happened now."""
        self._notes.append(_Event(self._clock.now(), text, level))

    def count(self, stream: str, counters: Counters) -> None:
        """Write down what happened to a stream so far."""
        self._counters[stream] = counters
        self._notes.append((self._clock.now(), stream, counters))

    def dropped(self, stream: str) -> int:
        """Count the samples of a stream that found no room."""
        return self._queues[stream].dropped

    def compare_clocks(self, clocks: Mapping[str, Mapping[str, float]]) -> None:
        """Take offset [s], drift [-] and delay [s] of each device's clock, for the end record."""
        self._clocks = dict(clocks)

    def end(self, reason: str) -> None:
        """Say why the run ends; the first reason stays."""
        if self._reason == "completed":
            self._reason = reason

    def judge(self, *, excluded: str, point: Mapping[str, Any]) -> None:
        """Say what the run is worth; the end record takes it, in one step with all else.

        Args:
            excluded: Why it is left out of every calibration; empty where it counts.
            point: Which point of an experiment it is, and whether it is good.
        """
        self._excluded, self._point = excluded, point

    def require_space(self) -> None:
        """Check that the disk has room.

        Raises:
            RecordingError: There is less than the limit.
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
        except (RecordingError, OSError) as error:
            shutil.rmtree(self.folder, ignore_errors=True)
            if isinstance(error, RecordingError):
                raise
            raise RecordingError(f"cannot write {self.folder}: {error.strerror}") from error
        for target in (self._write_on, self._sync_on):
            thread = threading.Thread(target=target, daemon=True, name="recorder")
            thread.start()
            self._threads.append(thread)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is not None:
            self.end(f"failed: {_one_line(error)}")
        self._ending.set()
        for thread in self._threads:
            thread.join(JOIN_LIMIT)
        self._finish()

    def _begin(self, began: datetime) -> None:
        given = self._description
        texts = {name: text for name, (_, text) in given.profiles.items()}
        for name, text in texts.items():
            profile_file(self.folder, name).parent.mkdir(exist_ok=True)
            atomic_write_text(profile_file(self.folder, name), text)
        (self.folder / _RESERVE_FILE).write_bytes(os.urandom(RESERVE))
        self._file = (self.folder / LOG_FILE).open("xb")
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
        write_manifest(self.folder, self._manifest)

    def _write_on(self) -> None:
        try:
            while not self._ending.wait(FLUSH_EVERY):
                self._drain()
                self._flush()
            self._drain()
        except Exception as error:  # noqa: BLE001, RUF100 - kept for the owner, who ends the run
            self._failure = f"{self.folder / LOG_FILE}: {_one_line(error)}"

    def _sync_on(self) -> None:
        while not self._ending.wait(SYNC_EVERY):
            with contextlib.suppress(OSError, ValueError):  # the writer meets it too, and says so
                if self._file is not None:
                    os.fsync(self._file.fileno())

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
        """Close the log and write the end record; what fails becomes its reason."""
        (self.folder / _RESERVE_FILE).unlink(missing_ok=True)
        if self._failure is not None:
            self.end(f"failed: {self._failure}")
        whole = self._failure is None and not any(thread.is_alive() for thread in self._threads)
        try:
            whole = self._close_log() if whole else False
        except OSError as error:
            whole, self._failure = False, f"{self.folder / LOG_FILE}: {_one_line(error)}"
            self.end(f"failed: {self._failure}")
        finally:
            if self._file is not None:
                with contextlib.suppress(OSError):
                    self._file.close()
        self._write_end_record(whole=whole)

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
        if self._manifest is None or self._log is None:
            return
        lasted = timedelta(seconds=self._clock.now() - self.start)
        log = self.folder / LOG_FILE
        if self._point and not whole:  # samples may be missing: the point is not finished
            self._point = {**self._point, "accepted": False}
            self._excluded = self._excluded or self._reason
        self._manifest = replace(
            self._manifest,
            stop=(datetime.fromisoformat(self._manifest.start) + lasted).isoformat(),
            exit_status=self._reason,
            streams=self._log.written,
            log_sha256=file_hash(log) if whole else None,
            counters={
                name: asdict(counters) | {"dropped": self.dropped(name)}
                for name, counters in self._counters.items()
            },
            clocks=self._clocks,
            excluded=_exclusion(self._excluded),
            point=self._point,
        )
        write_manifest(self.folder, self._manifest)


def _exclusion(why: str) -> Mapping[str, str] | None:
    return {"why": why} if why else None


def _one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())
