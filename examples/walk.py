# SPDX-License-Identifier: MIT
"""Compare where a turning gait leads by four walking models; everything is SIMULATED.

Usage: .venv/bin/python examples/walk.py
"""

import numpy as np

import zebro_lab as zl

print("model           distance   turned")
for model in ("dynamics", "thesis", "no-slip", "no-slip-simple"):
    slips = model in ("dynamics", "thesis")
    walk = zl.walk_gait(
        "tripod", steering=1.2, duration=10.0, model=model, slip="thesis" if slips else None
    )
    turned = np.degrees(walk.path.yaw[-1] - walk.path.yaw[0])
    print(f"{model:<14}  {walk.path.length:6.3f} m  {turned:5.1f} deg")

band = zl.walk_gait("tripod", steering=1.2, duration=10.0, slip="coulomb:0.38", draws=100)
ends = band.draws.position[:, -1]
print(f"with leg offsets unknown, the end scatters by {1000 * ends.std(axis=0).max():.0f} mm")
