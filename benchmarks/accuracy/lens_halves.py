# SPDX-License-Identifier: MIT
"""Whether lenses of two halves of a set of board photographs differ as much as they claim.

    python -m benchmarks.accuracy.lens_halves FOLDER

FOLDER holds the reference data. Each of its sets of checkerboards is split at random into disjoint
halves, sixty times; of fx, fy, cx, cy the root mean square of the difference over √2 is divided by
that of the claimed standard deviations. 1 is right. What all photographs of a set have in common,
such as a bent board, no halves can show.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from benchmarks.tables import print_table
from tracking.camera import Checkerboard, SeenBoard, calibrate, find_board
from tracking.errors import CalibrationError

SETS = {
    "640 x 480": ("realdata/checkerboards/left*.jpg", Checkerboard(9, 6, 0.025)),
    "1920 x 1080": ("realdata/checkerboards-hd/*.png", Checkerboard(10, 7, 0.015)),
    "virtual world, simulated": (
        "virtual-world/photos/calib/*.jpg", Checkerboard(9, 6, 0.03)
    ),
}  # fmt: skip
PAIRS = 60


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
        apart = (a.camera.matrix - b.camera.matrix)[[0, 1, 0, 1], [0, 1, 2, 2]]
        differences.append(apart**2 / 2)
        variances.append((a.sd[:4] ** 2 + b.sd[:4] ** 2) / 2)
    return float(np.sqrt(np.mean(differences) / np.mean(variances))), len(differences)


def main(folder: Path) -> None:
    """Print the table; the lens model is that which the whole set chooses."""
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
    main(Path(sys.argv[1]))
