# SPDX-License-Identifier: MIT
"""Run folders of a slip rig, made from samples in SI."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pandas as pd
import tomlkit

from zebro_lab.runs.manifest import RIG, RunManifest
from zebro_lab.runs.slip_rig_table import COLUMNS, SlipRigTable
from zebro_lab.runs.table_run import table_samples, write_table_run


def table_profile(*, radius_leg=0.035, radius_ground=0.12, rate=100.0) -> str:
    """Return the TOML of a rig whose speeds and forces are those of a table in SI."""
    document = {
        "schema": 1,
        "device": "slip-rig",
        "discs": {"radius_leg": radius_leg, "radius_ground": radius_ground},
        "board": {
            "link": "table", "rate": rate, "counts_per_force": 1.0, "counts_per_speed": 1.0,
            "normal_sign": 1, "traction_sign": 1,
        },
    }  # fmt: skip
    return tomlkit.dumps(document)


def slip_rig_run(data, table, *, start, radius_leg, radius_ground, source, **fields) -> Path:
    radii = {"radius_leg": radius_leg, "radius_ground": radius_ground}
    manifest = RunManifest(
        kind="slip-rig", start=start.astimezone(UTC).isoformat(), exit_status="completed",
        constants=radii, source=source, sources={"board": source}, **fields,
    )  # fmt: skip
    columns = ("normal_force", "traction_force", "omega_leg", "omega_ground")
    values = np.column_stack([getattr(table, name) for name in columns])
    step = float(np.median(np.diff(table.t))) if len(table) > 1 else 1.0
    profile = table_profile(**radii, rate=1 / step if step > 0 else 1.0)
    samples = {"board": table_samples(table.t, values)}
    return write_table_run(data, manifest, samples, profiles={RIG: profile})


def sweep_runs(
    data: Path, table: pd.DataFrame, *, start: datetime, label: str = "sweep"
) -> list[Path]:
    """Write a run folder for each run of a table in SI, in its order."""
    return [
        slip_rig_run(
            data, SlipRigTable(*run[list(COLUMNS)].to_numpy().T), start=start,
            label=f"{label} {name}", material="POM", operator="a", source="sim:rig-sweep",
            radius_leg=0.035, radius_ground=0.12,
        )
        for name, run in table.groupby("run", sort=False)
    ]  # fmt: skip
