# SPDX-License-Identifier: MIT
"""Whether a calibrated lens errs as much as its standard deviations say.

    python -m benchmarks.accuracy.lenses drawn [SETS [FIRST]]
    python -m benchmarks.accuracy.lenses halves FOLDER

`drawn`: SIMULATED sets of seven photographs of a checkerboard of 9 x 6 corners, 25 mm apart, each
of a lens of its own: field of view, principal point, distortion and sharpness are drawn, and
`camera calibrate` chooses the distortion model. Printed is how many 90 % intervals of fx, fy, cx
and cy hold the truth, how many of as many independent ones would (99 %, all four lines together),
and the root mean square of the errors by their standard deviations.

`halves`: each set of checkerboards of the reference data in FOLDER is split at random into disjoint
halves, sixty times; of fx, fy, cx, cy the root mean square of the difference over √2 is divided by
that of the claimed standard deviations. 1 is right. What all photographs of a set have in common,
such as a bent board, no halves can show.
"""

import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
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
from tracking.camera import CameraCalibration, Checkerboard, SeenBoard, calibrate, find_board
from tracking.errors import CalibrationError

PHOTOGRAPHS = 7
BOARD = Checkerboard(9, 6, 0.025)
QUIET = 1  # squares of white paper around
SIZE = (1280, 960)
NAMES = ("fx", "fy", "cx", "cy")
SETS = {
    "640 x 480": ("realdata/checkerboards/left*.jpg", Checkerboard(9, 6, 0.025)),
    "1920 x 1080": ("realdata/checkerboards-hd/*.png", Checkerboard(10, 7, 0.015)),
    "virtual world, simulated": (
        "virtual-world/photos/calib/*.jpg", Checkerboard(9, 6, 0.03)
    ),
}  # fmt: skip
PAIRS = 60


def pinhole(lens: CameraCalibration) -> NDArray[np.float64]:
    """Return fx, fy, cx and cy of a calibrated lens, shape (4,) [px]."""
    return np.asarray(lens.camera.matrix[[0, 1, 0, 1], [0, 1, 2, 2]], np.float64)


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


def calibrated(seed: int) -> tuple[NDArray[np.float64], str] | None:
    """Draw a set of photographs and calibrate its lens; None where a board is not found.

    Returns:
        Errors of fx, fy, cx, cy by their standard deviations, shape (4,) [-], and the lens model.
    """
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
    errors = (pinhole(fit) - [*camera.focal, *camera.centre]) / fit.sd[:4]
    return errors, fit.lens_model


def print_drawn(sets: int = 40, first: int = 0) -> None:
    """Print how many intervals of drawn lenses hold the truth."""
    with ProcessPoolExecutor() as pool:
        every = list(pool.map(calibrated, range(first, first + sets)))
    found = [each for each in every if each is not None]
    errors = np.array([each for each, _ in found])
    low, high = binom.interval(1 - 0.01 / len(NAMES), len(found), 0.9)
    rows = [
        (name, f"{(np.abs(column) < 1.6448536).sum()} of {len(found)}", f"{low:.0f} to {high:.0f}",
         f"{np.sqrt(np.mean(column**2)):.2f}")
        for name, column in zip(NAMES, errors.T, strict=True)
    ]  # fmt: skip
    print_table(("lens", "90 % hold", "expected", "rms of error / sd"), *rows)
    print(dict(Counter(model for _, model in found)), f"{sets - len(found)} without all boards")


def seen_boards(
    folder: Path, pattern: str, board: Checkerboard
) -> tuple[list[SeenBoard], tuple[int, int]]:
    """Detect a board in the photographs of a set; return it in each, and the photographs' size."""
    boards, size = [], (0, 0)
    for path in sorted(folder.glob(pattern)):
        picture = np.asarray(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE), dtype=np.uint8)
        size = (picture.shape[1], picture.shape[0])
        if (found := find_board(picture, board, name=path.name)) is not None:
            boards.append(found)
    return boards, size


def ratio(boards: list[SeenBoard], size: tuple[int, int], model: str) -> tuple[float, int]:
    """Compute the ratio of a set, and the number of pairs of which both halves have a lens."""
    rng, half = np.random.default_rng(0), len(boards) // 2
    differences, variances = [], []
    for _ in range(PAIRS):
        order = rng.permutation(len(boards))
        try:
            a, b = (
                calibrate([boards[k] for k in part], size, lens_model=model)
                for part in (order[:half], order[half : 2 * half])
            )
        except CalibrationError:
            continue
        differences.append((pinhole(a) - pinhole(b)) ** 2 / 2)
        variances.append((a.sd[:4] ** 2 + b.sd[:4] ** 2) / 2)
    return float(np.sqrt(np.mean(differences) / np.mean(variances))), len(differences)


def print_halves(folder: Path) -> None:
    """Print the ratio of each set; the lens model is that which the whole set chooses."""
    rows = []
    for name, (pattern, board) in SETS.items():
        boards, size = seen_boards(folder, pattern, board)
        whole = calibrate(boards, size)
        found, pairs = ratio(boards, size, whole.lens_model)
        focal = f"{whole.camera.matrix[0, 0]:.1f} ± {whole.sd[0]:.1f} px"
        errors = f"{whole.errors.noise:.2f}, {whole.errors.smooth:.2f} px"
        rows.append((name, str(len(boards)), whole.lens_model, focal, errors, f"{pairs}",
                     f"{found:.2f}"))  # fmt: skip
    print_table(
        ("boards", "photographs", "model", "fx", "corners err alone, alike", "pairs", "ratio"),
        *rows,
    )


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["halves", folder]:
            print_halves(Path(folder))
        case ["drawn", *numbers]:
            print_drawn(*map(int, numbers))
        case _:
            raise SystemExit(__doc__)
