# SPDX-License-Identifier: MIT
"""Write slip-rig samples that are already in SI as a finished run folder.

They are stored like raw samples, with a profile whose conversion factors are 1.
"""

from collections.abc import Callable, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rig.sample_columns import SampleColumns
from rig.slip_rig.profile import load_rig_profile, render_table_profile
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import DataError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.raw_log import raw_topic
from zebro_lab.mcap.slip_rig_log import SlipRigTable
from zebro_lab.mcap.stream_views import RigBoardView
from zebro_lab.runs.folder import LOG_FILE, epoch_ns, finished_run_folder
from zebro_lab.runs.manifest import (
    RIG,
    TABLE,
    RunManifest,
    profile_file,
    software_version,
    write_manifest,
)

_BOARD: Final = "board"
_BLOCK: Final = 1000  # samples per chunk; a truncated file loses at most one chunk


def write_slip_rig_run(
    data_dir: Path,
    table: SlipRigTable,
    *,
    label: str,
    material: str,
    operator: str,
    source: str,
    start: datetime,
    radius_leg: float,
    radius_ground: float,
    exit_status: str = "completed",
    commit: str = "unknown",
    inputs: Mapping[str, str] | None = None,
    extra: Callable[[Path], object] | None = None,
) -> Path:
    """Write a run of the slip rig as a new run folder, atomically.

    Args:
        data_dir: Folder of run folders; made when missing.
        table: The samples, at least one.
        label: Name of the run.
        material: Leg and ground material.
        operator: Name of the operator.
        source: "real", "sim:what", "replay:what" or "import:FILE".
        start: When sample time was 0, with its time zone.
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].
        exit_status: How the run ended.
        commit: Commit of the software that recorded it.
        inputs: SHA-256 of the files that the samples were imported from.
        extra: Called with the draft folder, to write more files before it is renamed.

    Returns:
        The run folder.

    Raises:
        DataError: There is no sample.
        AlreadyExists: A run with this start and label exists.
    """
    if len(table) == 0:
        raise DataError(f"run '{label}' has no samples to write")
    finished = finished_run_folder(data_dir, kind="slip-rig", label=label, start=start)
    with finished as (folder, draft):
        if extra is not None:
            extra(draft)
        profile = _write_profile(draft, table.t, radius_leg, radius_ground)
        _write_samples(draft, table, profile, start_ns=epoch_ns(start))
        manifest = RunManifest(
            kind="slip-rig",
            label=label,
            material=material,
            operator=operator,
            source=source,
            start=start.astimezone(UTC).isoformat(),
            stop=(start.astimezone(UTC) + timedelta(seconds=float(table.t[-1]))).isoformat(),
            exit_status=exit_status,
            software=software_version(commit),
            constants={"radius_leg": float(radius_leg), "radius_ground": float(radius_ground)},
            streams={raw_topic(_BOARD): len(table)},
            log_sha256=file_hash(draft / LOG_FILE),
            profiles={RIG: TABLE},
            sources={_BOARD: source},
            inputs=inputs or {},
        )
        write_manifest(draft, manifest)
    return folder


def _write_profile(
    draft: Path, t: NDArray[np.float64], radius_leg: float, radius_ground: float
) -> Path:
    """Write the profile of samples in SI, which decodes them unchanged."""
    step = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    file = profile_file(draft, RIG)
    file.parent.mkdir(exist_ok=True)
    text = render_table_profile(
        radius_leg=float(radius_leg),
        radius_ground=float(radius_ground),
        rate=1 / step if step > 0 else 1.0,
    )
    return atomic_write_text(file, text)


def _write_samples(draft: Path, table: SlipRigTable, profile: Path, *, start_ns: int) -> None:
    board = load_rig_profile(str(profile)).board
    if board is None:
        raise ValueError(f"{profile} describes no table")
    samples = _as_samples(table)
    with (draft / LOG_FILE).open("wb") as file:
        log = LogWriter(
            file,
            views={_BOARD: RigBoardView(_BOARD, profile=board)},
            attachments={f"{profile.parent.name}/{profile.name}": profile.read_text("utf-8")},
            start=0.0,
            start_ns=start_ns,
        )
        for first in range(0, len(samples), _BLOCK):
            log.write(_BOARD, samples[first : first + _BLOCK])
            log.flush()
        log.finish()


def _as_samples(table: SlipRigTable) -> SampleColumns:
    n = len(table)
    return SampleColumns(
        host_time=table.t,
        device_time=np.full(n, np.nan),
        sequence=np.full(n, -1, dtype=np.int64),
        status=np.zeros(n, dtype=np.uint32),
        channel=np.zeros(n, dtype=np.uint32),
        counts=np.column_stack([
            table.normal_force, table.traction_force, table.omega_leg, table.omega_ground,
        ]),
    )  # fmt: skip
