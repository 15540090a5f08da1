# SPDX-License-Identifier: MIT
"""Show that a slip ratio is a number only together with its definition.

Usage: .venv/bin/python examples/convert_slip.py
"""

import numpy as np

from model.errors import DefinitionMismatch
from model.slip import MagicFormula, SlipDefinition, convert_slip, require_definition, slip_ratio

speed_leg = 0.42  # m/s, how fast the leg's material passes the contact
print("ground [m/s]  " + "  ".join(f"{d:>8}" for d in SlipDefinition))
for speed_ground in (0.42, 0.40, 0.30, 0.21):
    row = [slip_ratio(speed_leg, speed_ground, d) for d in SlipDefinition]
    print(f"{speed_ground:12.2f}  " + "  ".join(f"{x:8.4f}" for x in row))

# Values fitted in one definition give the wrong force when fed the other.
law, values, load = MagicFormula(), (20.398, 1.564, 0.3798, 0.0066), 12.75
material = np.linspace(0.0, 0.99, 991)
travel = convert_slip(material, "material", "travel")
error = law.force(travel, load, values) - law.force(material, load, values)
worst = np.abs(error).max() / (0.3798 * load)
print(f"\ntravel slip fed to a material curve at {load} N: off by up to {worst:.0%} of the peak")

try:
    require_definition("travel", "material")
except DefinitionMismatch as refusal:
    print(f"so a mismatch is refused: {refusal}")
