# SPDX-License-Identifier: MIT
"""Read all streams of a run as curves in the units of a picture, with gaps and events."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from rig.clock_watch import sample_times
from rig.errors import RigError
from rig.imu.profile import ImuProfile, decode_orientation, load_imu_profile
from rig.sample_columns import SampleColumns
from rig.slip_rig.decode import Forces, decode_board, decode_forces, disc_speed
from rig.slip_rig.profile import RigProfile, load_rig_profile
from rig.zebro.profile import LegProfile, decode_angles, load_leg_profile
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.source_names import is_simulated
from zebro_lab.mcap.log_writer import LOG, WARNING
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.mcap.ros_log import read_messages
from zebro_lab.runs.folder import LOG_FILE, epoch_ns, require_profiles, run_state
from zebro_lab.runs.manifest import RIG, RunManifest, profile_file, read_manifest
from zebro_lab.runs.profile_streams import LEGS

Curves: TypeAlias = Iterator[tuple[str, str, Array, Mapping[str, Array]]]
"""Quantity, unit, times [s] and curves by name, of one stream after another."""
GAP_STEPS: Final = 5.0
GAP_LEAST: Final = 0.05
"""An interval is a gap when longer than `GAP_STEPS` median intervals and `GAP_LEAST` [s]."""


@dataclass(frozen=True)
class Panel:
    """Curves of one stream that share an axis.

    Attributes:
        title: Stream and quantity, such as `legs: angles, unwrapped`.
        unit: Unit of the values.
        t: Time of each sample since the start of the run, shape (n,) [s].
        lines: Values by name of the curve, each of shape (n,); NaN where not measured, but not
            throughout.
        simulated: Whether the stream is simulated.
        gaps: Begin and end of each gap, shape (k, 2) [s].
    """

    title: str
    unit: str
    t: Array
    lines: Mapping[str, Array]
    simulated: bool
    gaps: Array

    def measured(self) -> "Panel":
        """Return the panel without the curves of which nothing is measured."""
        lines = {name: line for name, line in self.lines.items() if np.isfinite(line).any()}
        return replace(self, lines=lines)

    def within(self, begin: float, end: float) -> "Panel":
        """Return the samples from `begin` to `end` [s], and the gaps that reach into this time."""
        kept = (self.t >= begin) & (self.t <= end)
        lines = {name: np.asarray(line)[kept] for name, line in self.lines.items()}
        gaps = self.gaps[(self.gaps[:, 0] < end) & (self.gaps[:, 1] > begin)]
        return replace(self, t=self.t[kept], lines=lines, gaps=gaps).measured()


@dataclass(frozen=True)
class Event:
    """Event in the log of a run.

    Attributes:
        t: Time since the start of the run [s].
        text: Description of the event.
        warning: Whether the event's level is warning or higher.
    """

    t: float
    text: str
    warning: bool


@dataclass(frozen=True)
class RunSignals:
    """Curves and events of a run.

    Attributes:
        name: Name of the run folder.
        state: State of the run, such as `completed`; `excluded: REASON` if it is excluded.
        source: Where the data come from.
        panels: Curves of all streams; zero offsets are not subtracted from forces.
        events: Events in the order of the log.
        notes: Notes on damage and dropped samples, one line each.
    """

    name: str
    state: str
    source: str
    panels: tuple[Panel, ...]
    events: tuple[Event, ...]
    notes: tuple[str, ...] = ()

    @property
    def span(self) -> tuple[float, float]:
        """First and last time of a sample of any stream [s]."""
        seen = [panel.t for panel in self.panels if len(panel.t)]
        return min(float(t[0]) for t in seen), max(float(t[-1]) for t in seen)

    def require_within(self, at: Sequence[float], *, key: str) -> None:
        """Check that times lie within the curves.

        Args:
            at: The times [s].
            key: Option that gave them, for the message.

        Raises:
            SettingsError: A time lies before or after all samples.
        """
        first, last = self.span
        for t in at:
            if not first <= t <= last:
                raise SettingsError(
                    f"found {t:g} s; expected times of what is drawn, {first:.3f} to {last:.3f} s",
                    key=key,
                )

    def within(self, begin: float, end: float) -> "RunSignals":
        """Return curves and events from `begin` to `end` [s]; streams with no sample there go.

        Raises:
            SettingsError: No stream has a sample in this time.
        """
        panels = [panel.within(begin, end) for panel in self.panels]
        drawn = tuple(panel for panel in panels if panel.lines)
        if not drawn:
            first, last = self.span
            raise SettingsError(
                f"found {begin:g}:{end:g} s; expected a time of the run, {first:.3f} to "
                f"{last:.3f} s",
                key="--window",
            )
        events = tuple(event for event in self.events if begin <= event.t <= end)
        return replace(self, panels=drawn, events=events)


def read_signals(folder: Path) -> RunSignals:
    """Read all streams of a recorded or imported run as curves, but for a damage of its log.

    Raises:
        NotFound: The folder is not a run folder, or its log is missing.
        DataError: Manifest, log or a profile is invalid, a profile is missing, or no stream has a
            finite value that a profile describes.
    """
    manifest = read_manifest(folder)
    log = folder / LOG_FILE
    raw = read_raw_log(log)
    require_profiles(folder, manifest)
    panels = [p for topic, stream in raw.streams.items()
              for p in _panels(folder, manifest, topic, stream)]  # fmt: skip
    notes = () if raw.damage is None else (f"{log} is incomplete ({raw.damage})",)
    measured = tuple(panel for panel in map(Panel.measured, panels) if panel.lines)
    if not measured:
        raise DataError("holds no samples to plot that the run's profiles describe", file=log)
    state = run_state(folder, manifest)
    if manifest.excluded is not None:
        state = f"excluded: {manifest.excluded.get('why', 'no reason given')}"
    events = _events(log, manifest)
    return RunSignals(folder.absolute().name, state, manifest.source, measured, events, notes)


def profile_of(folder: Path, name: str) -> Path:
    """Return the path of the profile that describes a stream.

    Legs and each IMU have a profile of their own; all other streams share that of the slip rig.

    Args:
        folder: The run folder.
        name: Name of the stream.
    """
    return profile_file(folder, name if name == LEGS or name.startswith("imu") else RIG)


def stream_decoder(name: str, place: Path) -> Callable[[Array, SampleColumns], Curves]:
    """Return what decodes samples of a stream, with the profile read once.

    It takes the times [s] of samples, shape (n,), and the samples, and yields quantity, unit, times
    and curves; nothing for a stream of the rig that the profile does not describe.

    Args:
        name: Name of the stream.
        place: Profile that describes it.

    Raises:
        RigError: The profile is missing or invalid.
    """
    if name == LEGS:
        return partial(_legs, load_leg_profile(str(place)))
    if name.startswith("imu"):
        return partial(_imu, load_imu_profile(str(place)))
    return partial(_rig, load_rig_profile(str(place)), name)


def find_gaps(t: Array, sequence: NDArray[np.int64] | None = None) -> Array:
    """Find gaps in a stream: long intervals between samples, and missing sequence numbers.

    Long is more than `GAP_STEPS` times the median positive interval, and more than `GAP_LEAST`.

    Args:
        t: Time of each sample, shape (n,) [s].
        sequence: Sequence number of each sample, -1 if it has none, shape (n,); None if the stream
            is not numbered.

    Returns:
        Begin and end of each gap, the times of the samples around it, shape (k, 2) [s].
    """
    steps = np.diff(t)
    usual = float(np.median(steps[steps > 0])) if np.any(steps > 0) else 0.0
    missing = steps > max(GAP_STEPS * usual, GAP_LEAST)
    if sequence is not None:
        numbered = (sequence[:-1] >= 0) & (sequence[1:] >= 0)
        missing |= numbered & (np.diff(sequence) > 1)
    at = np.flatnonzero(missing)
    return np.column_stack([t[at], t[at + 1]])


def _panels(
    folder: Path, manifest: RunManifest, topic: str, stream: SampleColumns
) -> Iterator[Panel]:
    """Decode a stream to panels, one per quantity; raise `DataError` if the profile does not fit.

    Gaps are found from times and sequence numbers of the whole stream; from the times alone for a
    part of it, such as the speed of one disc.
    """
    name = topic.split("/")[1]
    source = manifest.sources.get(name, manifest.source)
    t = sample_times(stream)
    gaps = find_gaps(t, stream.sequence)
    place = profile_of(folder, name)
    try:
        for what, unit, part, lines in stream_decoder(name, place)(t, stream):
            own = gaps if len(part) == len(t) else find_gaps(part)
            yield Panel(f"{name}: {what}", unit, part, lines, is_simulated(source), own)
    except RigError as error:
        raise DataError(str(error), file=place) from error


def _legs(profile: LegProfile, t: Array, stream: SampleColumns) -> Curves:
    """Yield the counts of each leg as they were sent, and its unwrapped angle [rad]."""
    angles = decode_angles(profile, stream)
    counts = {f"leg {leg}": stream.counts[:, i] for i, leg in enumerate(profile.legs)}
    unit = f"1/{profile.counts_per_revolution} turn"
    yield "counts as sent", unit, t, dict(sorted(counts.items()))
    theta = {f"leg {leg}": angles.theta[:, i] for i, leg in enumerate(angles.legs)}
    yield "angles, unwrapped", "rad", t, theta


def _imu(profile: ImuProfile, t: Array, stream: SampleColumns) -> Curves:
    """Yield orientation [deg], angular rate [rad/s] and specific force [m/s^2] of an IMU."""
    seen = decode_orientation(profile, stream)
    angles = {"roll": seen.roll, "pitch": seen.pitch, "yaw": seen.yaw}
    yield "orientation", "deg", t, {name: np.degrees(angle) for name, angle in angles.items()}
    yield "angular rate", "rad/s", t, dict(zip("xyz", seen.angular_rate.T, strict=True))
    yield "specific force", "m/s²", t, dict(zip("xyz", seen.specific_force.T, strict=True))


def _rig(profile: RigProfile, name: str, t: Array, stream: SampleColumns) -> Curves:
    """Yield speeds of the discs [rad/s] or forces [N] of one stream of the slip rig.

    The samples of the drives hold one disc each, told by their channel. Nothing is yielded for a
    stream that the profile does not describe.
    """
    if name == "drives" and profile.drives is not None:
        for disc, drive in (("leg", profile.drives.leg), ("ground", profile.drives.ground)):
            own = stream.channel == drive.node
            speed = disc_speed(drive, 1.0) * stream.counts[own, 1]
            yield f"speed of the {disc} disc", "rad/s", t[own], {disc: speed}
    elif name == "load_cell" and profile.load_cell is not None:
        yield "forces", "N", t, _forces(decode_forces(profile.load_cell, stream))
    elif name == "board" and profile.board is not None:
        forces, speeds = decode_board(profile.board, stream)
        yield "forces", "N", t, _forces(forces)
        yield "speeds of the discs", "rad/s", t, {"leg": speeds.leg, "ground": speeds.ground}


def _forces(forces: Forces) -> Mapping[str, Array]:
    """Return normal and traction force by the names of their curves, shape (n,) [N]."""
    return {"normal": forces.normal, "traction": forces.traction}


def _events(log: Path, manifest: RunManifest) -> tuple[Event, ...]:
    """Read the events in the log of a run, at times since its start."""
    start = epoch_ns(manifest.began)
    messages, _ = read_messages(log, (LOG,))
    return tuple(
        Event(1e-9 * (message.log_time - start), message.content.msg,
              message.content.level >= WARNING)
        for message in messages
    )  # fmt: skip
