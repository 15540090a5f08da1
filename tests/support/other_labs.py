# SPDX-License-Identifier: MIT
"""Tables of a rig and of a walk as other programs write them, with the column maps they need."""

from pathlib import Path

import numpy as np
import pandas as pd

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.bundled_walk import WALK
from support.simulated_sweep import simulate_sweep

SECONDS = 13.0  # of the bundled walk: seven strides
RIG_COLUMNS = """
source = "sim:rig-sweep"
runs.by = ["Versuch"]
load_cell.zero_stability = "0.1 N"
[columns]
t = { name = "Zeit", unit = "ms" }
omega_leg = { name = "n1", unit = "rpm" }
omega_ground = { name = "n2", unit = "rpm" }
normal_force = { name = "FZ", unit = "kN", sign = -1 }
traction_force = { name = "FX", unit = "N" }
[constants]
radius_leg = "35 mm"
radius_ground = "120 mm"
"""
WALK_COLUMNS = (
    """
source = "sim:mujoco-walk"
[legs.columns]
t = { name = "time", unit = "ms" }
"""
    + "".join(f'theta{leg} = {{ name = "leg {leg}", unit = "deg" }}\n' for leg in range(1, 7))
    + """[track.columns]
t_s = { name = "time", unit = "ms" }
x_m = { name = "X", unit = "mm" }
y_m = { name = "Y", unit = "mm" }
yaw_rad = { name = "heading", unit = "deg" }
"""
)


def rig_sweep() -> dict[str, np.ndarray]:
    """Return the samples of 24 simulated rig runs, in SI."""
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.9, 12) ** 1.5), loads=(4.0, 12.0), rate=60.0)
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG,
        rng=np.random.default_rng(1),
    ).table  # fmt: skip


def write_rig_table(folder: Path) -> Path:
    """Write a table of 24 simulated rig runs in German, with decimal commas."""
    drawn = rig_sweep()
    rpm = 60 / (2 * np.pi)
    table = pd.DataFrame({
        "Zeit": 1e3 * drawn["t"], "Versuch": drawn["run"], "n1": rpm * drawn["omega_leg"],
        "n2": rpm * drawn["omega_ground"], "FZ": -drawn["normal_force"] / 1e3,
        "FX": drawn["traction_force"],
    })  # fmt: skip
    table.to_csv(folder / "bench.csv", index=False, sep=";", decimal=",")
    return folder / "bench.csv"


def write_walk_tables(folder: Path) -> Path:
    """Write leg angles and a track of the bundled simulated walk, in degrees and millimetres."""
    legs = pd.read_csv(WALK / "legs.csv").query("t < @SECONDS")
    angles = {f"leg {leg}": np.degrees(legs[f"theta{leg}"]) for leg in range(1, 7)}
    pd.DataFrame({"time": 1e3 * legs["t"], **angles}).to_csv(folder / "legs.tsv", sep="\t",
                                                             index=False)  # fmt: skip
    seen = pd.read_csv(WALK / "truth.csv").query("t < @SECONDS").iloc[10::50]
    pd.DataFrame({
        "time": 1e3 * seen["t"], "X": 1e3 * seen["x"], "Y": 1e3 * seen["y"],
        "heading": np.degrees(seen["yaw"]),
    }).to_csv(folder / "capture.csv", index=False)  # fmt: skip
    (folder / "columns.toml").write_text(WALK_COLUMNS)
    return folder
