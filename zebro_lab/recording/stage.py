# SPDX-License-Identifier: MIT
"""Record devices into a run folder: open them, read them in threads, log, show status, end."""

import secrets
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol

from model.gait.reference import SampledReference
from rig.acquisition import Acquisition, acquiring
from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import RigError
from rig.zebro.commands import LEAD_IN
from zebro_lab.files.errors import RecordingError, SettingsError
from zebro_lab.files.source_names import is_twin, joined_source
from zebro_lab.mcap.log_writer import WARNING
from zebro_lab.recording.devices import DevicesRequest, OpenDevices, open_devices
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.run_files import needing_threads
from zebro_lab.recording.status import RecordStatus, StreamWatch, reading_failure
from zebro_lab.robot.leg_warnings import WARNING as SUSPECTED
from zebro_lab.robot.leg_warnings import leg_warnings
from zebro_lab.runs.manifest import RunManifest, read_manifest

PATIENCE: Final = 1.0
"""Timeout of one call of the display, after which the display is abandoned [s]."""


class Display:
    """Thread that passes the newest status to a display, until the display raises or hangs.

    Args:
        show: Draws a status; called in the display's thread, one call at a time.
        give_up: Called at most once, in any thread, with the reason why the display failed.
    """

    def __init__(
        self, show: Callable[[RecordStatus], object], *, give_up: Callable[[str], object]
    ) -> None:
        self._show = show
        self._give_up = give_up
        self._newest: RecordStatus | None = None
        self._since: float | None = None
        self._over = False
        self._ending = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, daemon=True, name="display")
        try:
            with needing_threads():
                self._thread.start()
        except RecordingError as error:
            self._end(f"the display cannot start, the recording continues without it: {error}")

    def show(self, status: RecordStatus) -> None:
        """Set the status to show next, replacing one not shown yet; does not block.

        A display whose present call has taken longer than `PATIENCE` is abandoned.
        """
        with self._changed:
            self._newest = status
            self._changed.notify()
            since = self._since
        if since is not None and time.monotonic() - since > PATIENCE:
            self._hangs()

    def close(self) -> None:
        """Show the last status and end the thread.

        A display that takes longer than `PATIENCE` is abandoned.
        """
        with self._changed:
            self._ending = True
            self._changed.notify()
        if self._thread.is_alive() and not self._over:
            self._thread.join(PATIENCE)
            if self._thread.is_alive():
                self._hangs()

    def _hangs(self) -> None:
        """Abandon the display because a call of it takes longer than `PATIENCE`."""
        self._end(f"the display hung for {PATIENCE:g} s, the recording continues without it")

    def _end(self, why: str) -> None:
        """Abandon the display; report the reason if it is the first."""
        with self._changed:
            first, self._over = not self._over, True
            self._changed.notify()
        if first:
            self._give_up(why)

    def _run(self) -> None:
        """Pass statuses to the display, in its thread, until it fails or is closed."""
        while (status := self._take()) is not None:
            try:
                self._show(status)
            except BaseException as error:  # noqa: BLE001, RUF100 - whatever a terminal or a plot may raise
                self._end(f"the display failed, the recording continues without it: {error!r}")

    def _take(self) -> RecordStatus | None:
        """Wait for a status and return it; None after a failure of the display.

        After `close` a status that is not shown yet is returned first, then None.
        """
        with self._changed:
            self._since = None
            self._changed.wait_for(lambda: self._newest is not None or self._ending or self._over)
            status, self._newest = self._newest, None
            if self._over:
                return None
            self._since = time.monotonic()
            return status


LOOK_EVERY: Final = 0.05
"""Interval between checks of the conditions that end a recording [s]."""
_SEED_BITS: Final = 31
"""Bits of a seed that nobody states: few digits, and no two runs of a laboratory are the same."""
_AS_THEY_ARE: Final = (
    "--play sends these angles as they are, without signs and offsets of a robot.toml: if the "
    "warning is right, stop, and repair the file or the columns.toml beside it"
)


class RecordWatcher(Protocol):
    """Interface of a display of a recording, which can also request the recording's end."""

    def note(self, line: str) -> None:
        """Show a line about the recording before it begins and before anything moves."""
        ...

    def show(self, status: RecordStatus) -> None:
        """Show the status, up to twenty times a second.

        Called in a separate thread; if it raises or hangs, the recording continues without it.
        """
        ...

    def stop_reason(self) -> str | None:
        """Return why the recording must end now, such as a signal's name; None to go on."""
        ...


@dataclass(frozen=True)
class Recorded:
    """A recorded run that has ended.

    Attributes:
        folder: The run folder.
        manifest: Manifest with the end record, as read from the folder.
    """

    folder: Path
    manifest: RunManifest


def record(
    request: RecordRequest, watcher: RecordWatcher, *, clock: Clock = SYSTEM_CLOCK
) -> Recorded:
    """Record devices into a new run folder until the duration, a stop or a failure ends it.

    The end of a played gait or of the longest replayed run ends it too.

    Args:
        request: Devices, duration and description of the run.
        watcher: Display of the status, which may also request the end.
        clock: Clock of host time.

    Returns:
        The run folder and its manifest.

    Raises:
        SettingsError: No device is named, the duration is not positive, a gait has no robot to
            play it, or the rig's profile has neither a board nor a load cell.
        NotFound: The leg angles to play or a replayed run are missing.
        DataError: They are invalid.
        RigError: A profile, an address or a port is invalid.
        AlreadyExists: A run of this kind, label and second exists.
        RecordingError: The run cannot begin, or ended early; then its folder holds the samples
            until then, and the reason, unless it was removed.
    """
    play, notes = (None, ()) if request.play is None else _played(request.play)
    for line in notes:
        watcher.note(line)
    duration = _duration(request, play)
    seed = secrets.randbits(_SEED_BITS) if request.seed is None else request.seed
    wanted = DevicesRequest(request.zebro, request.imus, request.rig, play, seed)
    with needing_threads(), ExitStack() as kept, open_devices(wanted) as opened:
        if opened.replayed:
            lasts = max(opened.replayed)
            duration = lasts if duration is None else min(lasts, duration)
        recorder = RunRecorder(
            request.data, manifest=_manifest(request, opened, seed),
            profiles=opened.profiles, clock=clock,
        )  # fmt: skip
        kept.enter_context(recorder)  # left after the devices: they wait for no disk
        for line in notes:
            recorder.event(line, level=WARNING)
        problem = _run(recorder, opened, watcher, duration, clock)
    if problem is not None or recorder.failure is not None:
        what = recorder.failure or problem
        where = f"the samples until then are in {recorder.folder}"
        if not recorder.folder.is_dir():
            where = "the samples until then are lost with the run folder"
        raise RecordingError(f"recording ended early: {what}; {where}")
    return Recorded(recorder.folder, read_manifest(recorder.folder))


def _run(
    recorder: RunRecorder,
    opened: OpenDevices,
    watcher: RecordWatcher,
    duration: float | None,
    clock: Clock,
) -> str | None:
    """Read all devices into the recorder until the end; return the failure, or None."""
    readers: Mapping[str, Acquisition] = {}
    display = Display(watcher.show, give_up=lambda why: recorder.event(why, level=WARNING))
    try:
        with (
            closing(display),
            needing_threads(),
            acquiring(opened.devices, sink=recorder, start=recorder.start, clock=clock) as readers,
        ):
            streams = StreamWatch(recorder, readers, opened.devices, duration)
            try:
                problem = _watch(streams, recorder, display, watcher, clock)
            finally:
                recorder.end()
                display.show(streams.status(clock.now()))
        problem = problem or reading_failure(readers)
        if problem is not None:
            recorder.end(f"failed: {problem}")
        return problem
    finally:
        _summarise(recorder, readers)


def _watch(
    streams: StreamWatch,
    recorder: RunRecorder,
    display: Display,
    watcher: RecordWatcher,
    clock: Clock,
) -> str | None:
    """Poll until duration, stop or failure ends the recording; return the failure, or None."""
    while (left := streams.left(now := clock.now())) > 0:
        streams.count()
        problem = streams.problem(now)
        reason = watcher.stop_reason()
        if problem is not None or reason is not None:
            recorder.end(f"failed: {problem}" if problem is not None else f"stopped: {reason}")
            return problem
        display.show(streams.status(now))
        clock.sleep(min(LOOK_EVERY, left))
    return None


def _summarise(recorder: RunRecorder, readers: Mapping[str, Acquisition]) -> None:
    """Pass the last counters and the clock fits to the recorder; log clocks that cannot be fit."""
    clocks = {}
    for name, reader in readers.items():
        recorder.count(name, reader.counters)
        try:
            fit = reader.clock_watch.result()
        except RigError as error:
            recorder.event(f"{name}: cannot fit the device's clock: {error}", level=WARNING)
            continue
        if fit is not None:
            clocks[name] = fit
    recorder.compare_clocks(clocks)


def _played(path: Path) -> tuple[SampledReference, tuple[str, ...]]:
    """Read a leg log to play: angles as they are [rad], times shifted to begin at 0 [s]; and notes.

    Signs and offsets of a `robot.toml` are not applied. The notes say what is suspected of the log.

    Raises:
        NotFound: The log does not exist.
        DataError: It cannot be read.
    """
    from zebro_lab.runs.legs import read_leg_log  # pandas takes half a second

    reference = read_leg_log(path).reference
    notes = leg_warnings(reference)
    if any(line.startswith(SUSPECTED) for line in notes):
        notes += (_AS_THEY_ARE,)
    return SampledReference(reference.t - reference.t[0], reference.theta), notes


def _duration(request: RecordRequest, play: SampledReference | None) -> float | None:
    """Return the shorter of requested duration and gait to play with its lead-in `LEAD_IN` [s].

    None, for no limit, without either. Raise `SettingsError` for a duration that is not positive.
    """
    wanted = [] if play is None else [LEAD_IN + float(play.t[-1])]
    if request.duration is not None:
        if not request.duration > 0:
            raise SettingsError(
                f"found {request.duration:g} s; expected more than 0 s", key="--duration"
            )
        wanted.append(request.duration)
    return min(wanted, default=None)


def _manifest(request: RecordRequest, opened: OpenDevices, seed: int) -> RunManifest:
    """Return the manifest of the run to begin; its seed is stated only if a device is simulated."""
    sources = {device.name: device.stream.source for device in opened.devices}
    return RunManifest(
        kind="walk" if request.rig is None else "slip-rig",
        label=request.label,
        source=joined_source(list(sources.values())),
        material=request.material,
        operator=request.operator,
        constants=opened.constants,
        sources=sources,
        robot=request.robot,
        truth=opened.truth,
        seed=seed if any(map(is_twin, sources.values())) else None,
    )
