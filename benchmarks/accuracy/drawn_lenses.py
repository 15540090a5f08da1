# SPDX-License-Identifier: MIT
"""How often the 90 % intervals of a calibrated lens hold the true one.

    python -m benchmarks.accuracy.drawn_lenses 40

SIMULATED sets of seven photographs of a checkerboard of 9 x 6 corners, 25 mm apart, each of a lens
of its own: field of view, principal point and distortion are drawn, and how sharp the photographs
are. The board is held at places all over the picture, tilted, in front of a grey wall. The
distortion model is the one that `camera calibrate` chooses. Printed is how many intervals of fx,
fy, cx and cy hold the truth, how many of as many independent ones would (99 %, all four
lines together), and the root mean square of the errors by their standard deviations.
"""

import argparse
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np
from scipy.stats import binom

from benchmarks.tables import print_table
from support.synthetic import (
    Conditions,
    DrawnPose,
    Sheet,
    SyntheticCamera,
    checkerboard_cells,
    develop,
    paint_sheets,
)
from support.synthetic.scene import Light
from tracking.camera import Checkerboard, calibrate, find_board

PHOTOGRAPHS = 7
BOARD = Checkerboard(9, 6, 0.025)
QUIET = 1  # squares of white paper around
SIZE = (1280, 960)
NAMES = ("fx", "fy", "cx", "cy")


@dataclass(frozen=True)
class Calibrated:
    """Errors of fx, fy, cx, cy by their standard deviations, shape (4,), and the model chosen."""

    errors: np.ndarray
    lens_model: str


def drawn_camera(rng: np.random.Generator) -> SyntheticCamera:
    """Draw a lens: of a telephone or a system camera, between 45 and 75 degrees wide."""
    focal = SIZE[0] / (2 * np.tan(np.radians(rng.uniform(45, 75)) / 2))
    centre = (np.array(SIZE) - 1) / 2 + rng.normal(0, 10, 2)
    k1, k2 = rng.uniform(-0.2, 0.05), rng.uniform(0, 0.05)
    p1, p2 = rng.normal(0, 5e-4, 2)
    return SyntheticCamera(
        *SIZE, (focal, focal * (1 + rng.normal(0, 1e-3))), (centre[0], centre[1]),
        (k1, k2, p1, p2, 0.0),
    )  # fmt: skip


def held(camera: SyntheticCamera, place: int, rng: np.random.Generator) -> Sheet:
    """Hold the board before the camera: one of seven places of the picture, tilted."""
    columns, rows = BOARD.columns + 1, BOARD.rows + 1
    size = (BOARD.square * (columns + 2 * QUIET), BOARD.square * (rows + 2 * QUIET))
    across = (0.3, 0.7, 0.3, 0.7, 0.5, 0.35, 0.65)[place] + rng.normal(0, 0.02)
    down = (0.32, 0.32, 0.68, 0.68, 0.5, 0.5, 0.5)[place] + rng.normal(0, 0.02)
    depth = rng.uniform(0.9, 1.2) * size[0] * camera.focal[0] / (0.5 * SIZE[0])
    tilt = rng.uniform(-0.6, 0.6, 3) * (1.0, 1.0, 0.5)
    turned = DrawnPose(0.0, 0.0, tilt[2], 0.0, tilt[0], tilt[1]).rotation
    at = depth * camera.rays((across * SIZE[0], down * SIZE[1]))
    return Sheet(
        checkerboard_cells(columns, rows, quiet=QUIET), size, at, turned @ np.diag([1.0, -1, -1])
    )


def calibrated(seed: int) -> Calibrated | None:
    """Draw a set of photographs, calibrate its lens; None where a board is not found."""
    rng = np.random.default_rng([11, seed])
    camera = drawn_camera(rng)
    conditions = Conditions(
        exposure=0.7, defocus_sd_px=rng.uniform(0.4, 1.5), read_noise_counts=1.5,
        shot_noise_counts=2.5, jpeg_quality=int(rng.integers(75, 96)),
    )  # fmt: skip
    wall = np.full((SIZE[1], SIZE[0], 3), 0.4, np.float32)
    light, boards = Light(direction=(0.3, -0.3, -1.0)), []
    for place in range(PHOTOGRAPHS):
        seen = paint_sheets(wall, [held(camera, place, rng)], camera=camera, light=light)
        pixels, _ = develop(seen, conditions, rng=rng)
        found = find_board(pixels, BOARD, name=f"p{place}")
        if found is not None:
            boards.append(found)
    if len(boards) < PHOTOGRAPHS:
        return None
    fit = calibrate(boards, SIZE)
    told = fit.camera.matrix[[0, 1, 0, 1], [0, 1, 2, 2]]
    return Calibrated((told - [*camera.focal, *camera.centre]) / fit.sd[:4], fit.lens_model)


def holding(sets: Sequence[Calibrated]) -> tuple[np.ndarray, tuple[int, int]]:
    """Count the 90 % intervals that hold the truth, shape (4,), and what is expected of them."""
    held = (np.abs([each.errors for each in sets]) < 1.6448536).sum(axis=0)
    low, high = binom.interval(1 - 0.01 / len(NAMES), len(sets), 0.9)
    return held, (int(low), int(high))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n")[0])
    parser.add_argument("sets", type=int, nargs="?", default=40)
    parser.add_argument("--first", type=int, default=0, help="number of the first set")
    asked = parser.parse_args()
    numbers = range(asked.first, asked.first + asked.sets)
    with ProcessPoolExecutor() as pool:
        every = list(pool.map(calibrated, numbers))
    sets = [each for each in every if each is not None]
    found, (low, high) = holding(sets)
    ratio = np.sqrt(np.mean(np.square([each.errors for each in sets]), axis=0))
    print_table(
        ("lens", "90 % hold", "expected", "rms of error / sd"),
        *((name, f"{count} of {len(sets)}", f"{low} to {high}", f"{r:.2f}")
          for name, count, r in zip(NAMES, found, ratio, strict=True)),
    )  # fmt: skip
    models = [each.lens_model for each in sets]
    print(", ".join(f"{name}: {models.count(name)}" for name in sorted(set(models))))
    print(f"sets in which a board was not found: {len(every) - len(sets)}")


if __name__ == "__main__":
    main()
