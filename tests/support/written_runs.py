# SPDX-License-Identifier: MIT
"""Run folders of the slip rig with made-up samples, written and edited."""

import json
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from support.table_runs import slip_rig_run
from zebro_lab.runs.slip_rig_table import SlipRigTable

START = datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)


def make_table(n: int) -> SlipRigTable:
    rng = np.random.default_rng(n)
    return SlipRigTable(
        np.arange(n) * 1e-3, 12 + rng.normal(size=n) / 10,
        np.linspace(3.5, 1.5, n) + rng.normal(size=n) / 10,
        6 + rng.normal(size=n) / 10, rng.normal(size=n),
    )  # fmt: skip


def make_run(data_dir: Path, n: int = 200, **change) -> Path:
    settings = {
        "label": "Delrin, steel", "material": "POM on steel", "operator": "a",
        "source": "sim:noise", "start": START, "radius_leg": 0.035, "radius_ground": 0.12,
    }  # fmt: skip
    return slip_rig_run(data_dir, make_table(n), **(settings | change))


def edit(folder: Path, **change) -> None:
    file = folder / "run.json"
    document = json.loads(file.read_text()) | change
    file.write_text(json.dumps({k: v for k, v in document.items() if v is not ...}))
