# SPDX-License-Identifier: MIT
"""Draw the thesis's slip curve at the four loads of its rig.

Usage: .venv/bin/python examples/plot_slip_curve.py [PICTURE]
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

from model.slip import MagicFormula

mpl.use("Agg")  # no window: the picture is a file
import matplotlib.pyplot as plt

# Eq. (4-45) and Listing A.20: B = 34.34, C = 1.564, D = 0.3798·Fn, peak at a slip of 0.0066·Fn.
B, C, mu, peak_per_load = 34.34, 1.564, 0.3798, 0.0066
law = MagicFormula(curvature="peak")
values = (B * C * mu, C, mu, peak_per_load)

slip = np.linspace(0.0, 1.0, 400)
figure, axes = plt.subplots(layout="constrained")
for load in (2.13, 6.63, 8.13, 12.75):
    axes.plot(slip, law.force(slip, load, values), label=f"{load:g} N")
    peak = float(law.peak_slip(load, values))
    print(f"at {load:5.2f} N the force peaks at {mu * load:.3f} N, slip ratio {peak:.4f}")
axes.set_xlabel("slip ratio, material definition [-]")
axes.set_ylabel("traction force [N]")
axes.legend(title="normal force")

picture = Path(sys.argv[1] if len(sys.argv) > 1 else "slip_curve.png")
figure.savefig(picture)
print(f"wrote {picture}")
