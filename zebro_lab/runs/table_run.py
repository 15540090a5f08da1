# SPDX-License-Identifier: MIT
"""Write samples that are already decoded as a finished run folder.

They are stored like raw samples, with profiles that decode them: of an IMU in SI with scale 1, of
legs in degrees.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from rig.sample_columns import SampleColumns
from zebro_lab.files.atomic import atomic_folder, atomic_write_text
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.log_writer import WARNING, LogWriter
from zebro_lab.mcap.raw_log import raw_topic
from zebro_lab.runs.folder import LOG_FILE, epoch_ns, require_new, run_path
from zebro_lab.runs.manifest import TABLE, RunManifest, profile_file, write_manifest
from zebro_lab.runs.profile_streams import stored_streams

_BLOCK: Final = 100  # samples per chunk; a truncated file loses one


def write_table_run(
    data_dir: Path,
    manifest: RunManifest,
    samples: Mapping[str, SampleColumns],
    *,
    profiles: Mapping[str, str],
    event: str = "",
    warnings: Sequence[str] = (),
    extra: Callable[[Path], object] | None = None,
    until: float = 0.0,
) -> Path:
    """Write samples as a new run folder, atomically.

    Args:
        data_dir: Folder of run folders; created when missing.
        manifest: Manifest of the run, with its start; stop, streams, checksum and profiles are set
            here.
        samples: Samples of each stream, at least one each, by the stream's name; host times since
            the start of the run. Without streams the log holds the events alone.
        profiles: TOML text of each profile, by its name in the run folder.
        event: Text of an event to log at time 0; empty for none.
        warnings: Texts of further events to log at time 0, each as a warning.
        extra: Called with the draft folder, to write more files before the folder gets its name.
        until: Time at which the run without streams ends, since its start [s].

    Returns:
        The run folder.

    Raises:
        AlreadyExists: A run of this kind, start and label exists.
        RigError: A profile is invalid.
        OSError: The folder cannot be written.
    """
    folder = run_path(data_dir, manifest.kind, manifest.label, manifest.began)
    require_new(folder)
    with atomic_folder(folder) as draft:
        if extra is not None:
            extra(draft)
        for name, text in profiles.items():
            profile_file(draft, name).parent.mkdir(exist_ok=True)
            atomic_write_text(profile_file(draft, name), text)
        _write_log(draft, manifest, samples, profiles, event, warnings)
        lasted = max((float(columns.host_time[-1]) for columns in samples.values()), default=until)
        manifest = replace(
            manifest,
            stop=(manifest.began + timedelta(seconds=lasted)).isoformat(),
            streams={raw_topic(name): len(columns) for name, columns in samples.items()},
            log_sha256=file_hash(draft / LOG_FILE),
            profiles=dict.fromkeys(profiles, TABLE),
        )
        write_manifest(draft, manifest)
    return folder


def _write_log(
    draft: Path,
    manifest: RunManifest,
    samples: Mapping[str, SampleColumns],
    profiles: Mapping[str, str],
    event: str,
    warnings: Sequence[str],
) -> None:
    """Write samples and events to the log of a run.

    Blocks of `_BLOCK` samples of all streams are written in the order of time, as while recording.
    """
    blocks = [
        (name, columns[first : first + _BLOCK])
        for name, columns in samples.items()
        for first in range(0, len(columns), _BLOCK)
    ]
    with (draft / LOG_FILE).open("wb") as file:
        log = LogWriter(
            file, streams=stored_streams(draft, profiles), start=0.0,
            attachments={f"profiles/{name}.toml": text for name, text in profiles.items()},
            start_ns=epoch_ns(manifest.began),
        )  # fmt: skip
        if event:
            log.event(0.0, event)
        for text in warnings:
            log.event(0.0, text, level=WARNING)
        for name, block in sorted(blocks, key=lambda each: each[1].host_time[-1]):
            log.write(name, block)
            log.flush()
        log.finish()


def table_samples(t: Array, values: Array) -> SampleColumns:
    """Return decoded values as raw samples without device times, sequence numbers or status.

    Args:
        t: Time of each sample since the start of the run, shape (n,) [s].
        values: Values in the order and the unit of the counts in the profile, shape (n, width).
    """
    n = len(t)
    return SampleColumns(
        host_time=t,
        device_time=np.full(n, np.nan),
        sequence=np.full(n, -1, dtype=np.int64),
        status=np.zeros(n, dtype=np.uint32),
        channel=np.zeros(n, dtype=np.uint32),
        counts=values,
    )
