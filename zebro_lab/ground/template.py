# SPDX-License-Identifier: MIT
"""A commented `ground.toml`, as a template for editing."""

from typing import Final

TEMPLATE: Final = """\
# Ground of a walk: zebro-lab walk --ground {name} --slip thesis --duration 20 --figures
# Change the values, take # away from what you need, and delete what you do not. All parts are
# optional, and they add up. x is ahead of the robot at its start, y to its left, z up.
# Lengths are in m, or texts with a unit such as "5 mm". docs/formats.md explains every key.

# By which a plane through the start rises along x and along y, from -45 to 45.
slope_deg = [0.0, 0.0]

# A map of heights seen from above, a table of numbers alone, the first row the farthest. step:
# distance of its places; origin: x and y of the lower left one; unit: m by default.
# heights = {{ file = "h.csv", step = 0.005, origin = [-0.5, -0.5], unit = "mm" }}
"""
