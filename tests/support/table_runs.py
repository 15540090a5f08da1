# SPDX-License-Identifier: MIT
"""Run folders of a slip rig, made from samples in SI."""

from datetime import UTC
from pathlib import Path

from zebro_lab.runs.manifest import RunManifest
from zebro_lab.runs.table_run import write_slip_rig_run


def slip_rig_run(data, table, *, start, radius_leg, radius_ground, **fields) -> Path:
    manifest = RunManifest(
        kind="slip-rig", start=start.astimezone(UTC).isoformat(), exit_status="completed",
        constants={"radius_leg": radius_leg, "radius_ground": radius_ground}, **fields,
    )  # fmt: skip
    return write_slip_rig_run(data, table, manifest)
