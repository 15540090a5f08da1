# SPDX-License-Identifier: MIT
"""Devices in, run folder out."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Protocol

from model.gait.reference import SampledReference
from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters
from zebro_lab.acquisition import Acquisition, acquiring
from zebro_lab.errors import RecordingError, SettingsError
from zebro_lab.gait_player import LEAD_IN
from zebro_lab.leg_log import read_leg_log
from zebro_lab.record_devices import DevicesRequest, OpenDevices, open_devices
from zebro_lab.recorder import RunDescription, RunRecorder
from zebro_lab.ros_messages import WARNING
from zebro_lab.run_manifest import RunManifest, read_manifest
from zebro_lab.source_names import joined_source

LOOK_EVERY: Final = 0.05
COUNT_EVERY: Final = 1.0


@dataclass(frozen=True)
class RecordRequest:
    """What is asked of a recording.

    Attributes:
        data: Folder of run folders.
        label: Name of the run.
        zebro: Robot: `PROFILE@PORT`, `PROFILE@sim` or `sim`; None for none.
        imus: Inertial measurement units, the same.
        rig: Slip rig, the same.
        play: Table or walk folder with leg angles that the robot is to follow.
        duration: How long to record; None until it is stopped, or the played gait ends [s].
        material: Leg and ground material.
        operator: Who records.
        robot: Name of the robot.
        seed: Of the randomness of simulated devices.
    """

    data: Path
    label: str
    zebro: str | None = None
    imus: tuple[str, ...] = ()
    rig: str | None = None
    play: Path | None = None
    duration: float | None = None
    material: str = "unknown"
    operator: str = "unknown"
    robot: str | None = None
    seed: int = 0


@dataclass(frozen=True)
class StreamStatus:
    """How a stream is doing.

    Attributes:
        source: Where it comes from.
        rate: Samples in the last second or so [Hz].
        counters: What happened so far.
        dropped: Samples that the recorder dropped.
    """

    source: str
    rate: float
    counters: Counters
    dropped: int


@dataclass(frozen=True)
class RecordStatus:
    """How a recording is doing.

    Attributes:
        folder: The run folder.
        elapsed: Time since it began [s].
        duration: How long it is to be; None where nobody knows [s].
        streams: Each stream, by its name.
    """

    folder: Path
    elapsed: float
    duration: float | None
    streams: Mapping[str, StreamStatus] = field(default_factory=dict)


class RecordWatcher(Protocol):
    """Who looks on, and may end a recording."""

    def show(self, status: RecordStatus) -> None:
        """Take how it is doing, some twenty times a second."""
        ...

    def stop_reason(self) -> str | None:
        """Say why it is to end now; None where it is to go on."""
        ...


@dataclass(frozen=True)
class Recorded:
    """A run that has been recorded.

    Attributes:
        folder: The run folder.
        manifest: Its end record.
    """

    folder: Path
    manifest: RunManifest


def record(
    request: RecordRequest, watcher: RecordWatcher, *, clock: Clock = SYSTEM_CLOCK
) -> Recorded:
    """Record devices as a run folder.

    Raises:
        SettingsError: No device is named, or what is asked cannot be.
        RigError: A profile, an address or a port is not right.
        RecordingError: The run ended early; its folder holds what came before, and the reason.
    """
    play = None if request.play is None else _played(request.play)
    duration = _duration(request, play)
    wanted = DevicesRequest(request.zebro, request.imus, request.rig, play, request.seed)
    with open_devices(wanted) as opened:
        views = {device.name: device.view for device in opened.devices}
        recorder = RunRecorder(
            request.data, description=_description(request, opened), views=views, clock=clock
        )
        with recorder:
            problem = _run(recorder, opened, watcher, duration, clock)
    if problem is not None or recorder.failure is not None:
        raise RecordingError(
            f"recording ended early: {problem or recorder.failure}; what came before is in "
            f"{recorder.folder}"
        )
    return Recorded(recorder.folder, read_manifest(recorder.folder))


def _run(
    recorder: RunRecorder,
    opened: OpenDevices,
    watcher: RecordWatcher,
    duration: float | None,
    clock: Clock,
) -> str | None:
    """Record until something ends it; return what went wrong, if anything."""
    with acquiring(opened.devices, sink=recorder, start=recorder.start, clock=clock) as readers:
        board = _Board(recorder, readers, opened, duration)
        display = _Display(recorder, watcher)
        counted = recorder.start
        problem = None
        while (now := clock.now()) - recorder.start < (duration or float("inf")):
            if now - counted >= COUNT_EVERY:
                counted = now
                board.count()
                recorder.require_space()
            problem = recorder.failure or _failed(readers)
            reason = watcher.stop_reason()
            if problem is not None or reason is not None:
                recorder.end(f"failed: {problem}" if problem is not None else f"stopped: {reason}")
                break
            display.show(board.status(now))
            left = recorder.start + (duration or float("inf")) - clock.now()
            clock.sleep(min(LOOK_EVERY, max(left, 0.0)))
        display.show(board.status(clock.now()))
    board.count()
    clocks = {name: reader.clock_watch.result() for name, reader in readers.items()}
    recorder.compare_clocks({name: fit for name, fit in clocks.items() if fit is not None})
    return problem


class _Display:
    """Shows how it is doing, until that fails: a picture is no reason to end a run."""

    def __init__(self, recorder: RunRecorder, watcher: RecordWatcher) -> None:
        self._recorder = recorder
        self._watcher: RecordWatcher | None = watcher

    def show(self, status: RecordStatus) -> None:
        """Show it, or note in the log why from now on nothing is shown."""
        if self._watcher is None:
            return
        try:
            self._watcher.show(status)
        except Exception as error:  # whatever a terminal or a plot may raise
            self._watcher = None
            text = f"display failed, recording goes on without it: {error!r}"
            self._recorder.event(text, level=WARNING)


class _Board:
    """Keeps the counters of all streams, for the log and for the watcher."""

    def __init__(
        self,
        recorder: RunRecorder,
        readers: Mapping[str, Acquisition],
        opened: OpenDevices,
        duration: float | None,
    ) -> None:
        self._recorder = recorder
        self._readers = readers
        self._sources = {device.name: device.stream.source for device in opened.devices}
        self._duration = duration
        self._rates = dict.fromkeys(readers, 0.0)
        self._before = (recorder.start, dict.fromkeys(readers, 0))

    def count(self) -> None:
        """Write all counters to the log."""
        for name, reader in self._readers.items():
            self._recorder.count(name, reader.counters)

    def status(self, now: float) -> RecordStatus:
        """Say how the recording is doing."""
        began, received = self._before
        if now - began >= COUNT_EVERY:
            current = {name: r.counters.received for name, r in self._readers.items()}
            self._rates = {name: (current[name] - received[name]) / (now - began)
                           for name in current}  # fmt: skip
            self._before = (now, current)
        streams = {
            name: StreamStatus(
                self._sources[name], self._rates[name], reader.counters,
                self._recorder.dropped(name),
            )
            for name, reader in self._readers.items()
        }  # fmt: skip
        elapsed = now - self._recorder.start
        return RecordStatus(self._recorder.folder, elapsed, self._duration, streams)


def _failed(readers: Mapping[str, Acquisition]) -> str | None:
    for name, reader in readers.items():
        if reader.failure is not None:
            return f"{name}: {type(reader.failure).__name__}: {reader.failure}"
    return None


def _played(path: Path) -> SampledReference:
    reference = read_leg_log(path).reference
    return SampledReference(reference.t - reference.t[0], reference.theta)


def _duration(request: RecordRequest, play: SampledReference | None) -> float | None:
    wanted = [] if play is None else [LEAD_IN + float(play.t[-1])]
    if request.duration is not None:
        if not request.duration > 0:
            raise SettingsError(
                f"{request.duration:g} s is no duration; expected more than 0", key="--duration"
            )
        wanted.append(request.duration)
    return min(wanted, default=None)


def _description(request: RecordRequest, opened: OpenDevices) -> RunDescription:
    sources = {device.name: device.stream.source for device in opened.devices}
    return RunDescription(
        kind="walk" if request.rig is None else "slip-rig",
        label=request.label,
        source=joined_source(list(sources.values())),
        material=request.material,
        operator=request.operator,
        constants=opened.constants,
        profiles=opened.profiles,
        sources=sources,
        robot=request.robot,
        truth=opened.truth,
    )
