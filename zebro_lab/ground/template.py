# SPDX-License-Identifier: MIT
"""Write a commented `ground.toml`, as a template for editing."""

from pathlib import Path
from typing import Final

from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import AlreadyExists

TEMPLATE: Final = """\
# Ground of a walk: zebro-lab walk --ground {name} --slip thesis --duration 20 --figures
# Change the values, take # away from what you need, and delete what you do not. All parts are
# optional, and their heights add up. x is ahead of the robot at its start, y to its left, z up.
# Lengths are in m, or texts with a unit such as "5 mm". docs/formats.md explains every key.

# By which a plane through the start rises along x and along y, from -45 to 45.
slope_deg = [0.0, 0.0]

# A Gaussian random field of standard deviation sd; the same seed gives the same one.
# roughness = {{ sd = 0.002, correlation = 0.05, seed = 1 }}

# A map of heights seen from above, the first row the farthest: a table (numbers alone), or a grey
# picture of 16 bits. step: distance of its places; origin: x and y of the lower left one; unit: of
# a table, m by default; range: of a picture, heights of black (0) and white (65535).
# heights = {{ file = "h.csv", step = 0.005, origin = [-0.5, -0.5], unit = "mm" }}
# heights = {{ file = "h.png", step = 0.005, origin = [-0.5, -0.5], range = [0.0, 0.02] }}

# A step across the way: from x on the ground is higher by height, or lower if that is negative.
# Repeat it for more.
# [[step]]
# x = 0.6
# height = 0.01

# A patch of another material: corners in order, and its slip law as --slip takes it: a slip.toml
# or its folder beside this file, coulomb:MU[:V] or thesis. Repeat it for more; the last one counts
# where some overlap.
# [[area]]
# polygon = [[0.9, -0.5], [1.4, -0.5], [1.4, 0.5], [0.9, 0.5]]
# slip = "coulomb:0.15"
"""


def write_ground_template(file: Path, *, force: bool = False) -> Path:
    """Write a commented `ground.toml` of level ground, with every key beside an example.

    Args:
        file: File to write.
        force: Whether to replace an existing file.

    Raises:
        AlreadyExists: The file exists, and `force` is not set; or it is a folder.
        OSError: The file cannot be written.
    """
    if file.is_dir():
        raise AlreadyExists(f"{file} is a folder; name the file to write, such as ground.toml")
    if file.exists() and not force:
        raise AlreadyExists(
            f"{file} exists already; edit it, replace it with --force, or choose another file name"
        )
    return atomic_write_text(file, TEMPLATE.format(name=file.name))
