# SPDX-License-Identifier: MIT
"""Fit the slip law to the bundled, SIMULATED rig data and draw it with its uncertainty.

Usage: .venv/bin/python examples/calibrate.py [DATA [PICTURE [STEPS]]]
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

import zebro_lab as zl

mpl.use("Agg")  # no window: the picture is a file
import matplotlib.pyplot as plt

bundled = Path(__file__).parents[1] / "datasets" / "rig-sim"
data = sys.argv[1] if len(sys.argv) > 1 else bundled
picture = sys.argv[2] if len(sys.argv) > 2 else "slip_curve.png"
steps = int(sys.argv[3]) if len(sys.argv) > 3 else 30_000

result = zl.calibrate(data, max_steps=steps)
print(result.verdict.headline())
print(result.summary[["median", "q05", "q95"]])

curve, slip = result.curve, np.linspace(0.0, 1.0, 400)
draws = result.calibration.draws.flat[::100, : len(curve.values)]
figure, axes = plt.subplots(layout="constrained")
for load in (2.13, 12.75):
    forces = np.array([curve.law.force(slip, load, values) for values in draws])
    axes.fill_between(slip, *np.quantile(forces, [0.05, 0.95], axis=0), alpha=0.3)
    axes.plot(slip, curve.law.force(slip, load, curve.values), label=f"{load:g} N")
axes.set(xlabel=f"slip ratio, {curve.definition} definition [-]", ylabel="traction force [N]")
axes.set_title("Slip curve (simulated data)")
axes.legend(title="normal force")
figure.savefig(picture)
print(f"wrote {picture}")
