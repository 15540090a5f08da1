# SPDX-License-Identifier: MIT
"""Replay a recorded run instead of a device (`replay:RUN`), at its recorded pace."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from rig.openers import REPLAY
from rig.replay import ReplayStream
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.source_names import is_simulated
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import RunManifest, profile_file, read_manifest
from zebro_lab.runs.profile_streams import IMU, LEGS, profile_streams

_RIG_STREAMS: Final = ("drives", "load_cell", "board")
_MARGIN: Final = 1e-3  # so that rounding loses no last sample [s]


@dataclass(frozen=True)
class Replayed:
    """Streams of a replayed run.

    Attributes:
        streams: Replaying streams, not yet entered.
        profile: Name and TOML text of the streams' profile.
        manifest: Manifest of the recorded run.
        lasts: Longest time from first to last sample of a stream, plus a margin of 1 ms [s].
    """

    streams: tuple[ReplayStream, ...]
    profile: tuple[str, str]
    manifest: RunManifest
    lasts: float


def read_replay(address: str, what: str, *, name: str | None = None) -> Replayed:
    """Read the streams of a recorded run that replace a device.

    Args:
        address: `replay:RUN`, with the run folder.
        what: Kind of device: `legs`, `imu` or `rig`.
        name: Name of the replayed IMU stream; the run's stream of this name is replayed, or its
            first IMU if it has none. None for other devices.

    Returns:
        The streams, of a damaged log without the damage. Their source is `replay:RUN`, or
        `sim:replay:RUN` for simulated samples.

    Raises:
        NotFound: The run, its log or its profile is missing.
        DataError: The manifest is invalid, the log is not MCAP, or the log or the profile has no
            such stream.
        RigError: The run's profile is invalid.
    """
    folder = Path(address.removeprefix(REPLAY))
    manifest = read_manifest(folder)
    found = read_raw_log(folder / LOG_FILE).streams
    names = {topic.split("/")[1]: topic for topic in found}
    chosen = _chosen(what, name, tuple(names))
    if not chosen:
        has = ", ".join(names) or "none"
        raise DataError(f"has no samples of {what} to replay; its streams: {has}", file=folder)
    kept = chosen[0] if what == IMU else what
    file = profile_file(folder, kept)
    if not file.is_file():
        raise NotFound(f"{file}: missing; copy it from the computer where the run was recorded")
    described = profile_streams(file)
    for each in chosen:
        if each not in described:
            raise DataError(
                f"does not describe stream '{each}' of the log, as the recorded rig's does; "
                "copy that profile from the computer where the run was recorded",
                file=file,
            )
    streams = {name or each: (each, found[names[each]]) for each in chosen}
    return Replayed(
        tuple(
            ReplayStream(samples, name=each, source=_source(folder, manifest, own))
            for each, (own, samples) in streams.items()
        ),
        (manifest.profiles.get(kept, file.stem), file.read_text(encoding="utf-8")),
        manifest,
        max(float(s.host_time[-1] - s.host_time[0]) for _, s in streams.values()) + _MARGIN,
    )


def _chosen(what: str, name: str | None, found: tuple[str, ...]) -> tuple[str, ...]:
    """Return the streams to replay of those found: all of legs or rig, one of IMUs.

    That is the IMU `name`, else the first.
    """
    if what == LEGS:
        return tuple(each for each in found if each == LEGS)
    if what == IMU:
        imus = [each for each in found if each.startswith(IMU)]
        return (name,) if name in imus else tuple(imus[:1])
    return tuple(each for each in found if each in _RIG_STREAMS)


def _source(folder: Path, manifest: RunManifest, stream: str) -> str:
    """Return the source of a replayed stream: `replay:RUN`, with `sim:` before it if simulated."""
    simulated = is_simulated(manifest.sources.get(stream, manifest.source))
    return f"{'sim:' * simulated}{REPLAY}{folder.absolute().name}"
