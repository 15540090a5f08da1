# SPDX-License-Identifier: MIT
"""Time the tracker beside a bare call of OpenCV's detector on the same 12 MP photographs.

Prints the tables of docs/benchmarks.md's section on tracking. The photographs are simulated: four
markers on the floor, the robot 0.1 m farther on in each. Both are timed in turn on each photograph,
decoded, in one process; seconds are the processor's, summed over threads, and wall time. `track`
searches many photographs in two processes of one thread: so do the last rows, whose wall time is
divided by the processes. Smoothing is timed beside scipy's splines.
"""

import multiprocessing
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Any

import cv2
import numpy as np
from scipy.interpolate import make_smoothing_spline

from benchmarks.machine import describe_machine
from benchmarks.tables import print_table
from support.synthetic import (
    Conditions,
    DrawnFloorMarker,
    DrawnPose,
    DrawnScene,
    RobotState,
    look_at,
    render_background,
    take_photo,
)
from tracking.camera import Camera
from tracking.constant_twist import Process
from tracking.detect import Detection, MarkedRobot, RobotMarker, detect, observe
from tracking.floor import FloorMap, FloorMarker, refine_floor
from tracking.path import assemble_track
from tracking.pose import BodyPrior
from tracking.smooth import smooth

SIZE = (4000, 3000)
PHOTOS = 8
REPEATS = 3
WORKERS = 2  # as `track` has by default
STRETCHES = (2, 4, 8)
POSES = (200, 1600)
POSE_SD = np.array([2e-3, 2e-3, 5e-3])  # m, m, rad
PLACES = ((0.1, -0.1, 0.3), (1.5, -0.1, -0.4), (1.6, 1.2, 0.5), (0.0, 1.3, -0.2))
CAMERA = look_at((0.8, -1.2, 1.8), (0.8, 0.6, 0.0), width=SIZE[0], height=SIZE[1])
LENS = Camera(SIZE, CAMERA.matrix, np.array(CAMERA.distortion))
FLOOR = FloorMap("4x4_50", tuple(
    FloorMarker(10 + k, 0.12, x, y, yaw=yaw) for k, (x, y, yaw) in enumerate(PLACES)
))  # fmt: skip
ROBOT = MarkedRobot(RobotMarker(0, 0.12, "4x4_50", (0.0, 0.0, 0.0385)), BodyPrior(0.0645))


def photographs() -> list[np.ndarray]:
    """Draw the photographs."""
    drawn = (DrawnFloorMarker(10 + k, (x, y), 0.12, yaw) for k, (x, y, yaw) in enumerate(PLACES))
    scene = DrawnScene(CAMERA, tuple(drawn))
    background, rng = render_background(scene), np.random.default_rng(0)
    return [
        take_photo(
            scene, RobotState(DrawnPose(0.25 + 0.1 * n, 0.3 + 0.03 * n, 0.3 + 0.02 * n)),
            conditions=Conditions(defocus_sd_px=1.0), rng=rng, background=background,
        ).pixels
        for n in range(PHOTOS)
    ]  # fmt: skip


def timed(work: Callable[[], Any]) -> tuple[float, float, Any]:
    """Return the processor's seconds, those of the wall, and what came of it."""
    began, wall = time.process_time(), time.perf_counter()
    result = work()
    return time.process_time() - began, time.perf_counter() - wall, result


def side_by_side(photos: Sequence[np.ndarray], threads: int) -> tuple[np.ndarray, list[Detection]]:
    """Time both on each photograph in turn, shape (photographs, ours and bare, CPU and wall)."""
    cv2.setNumThreads(threads)
    bare = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50))
    hint, rows, found = detect("first", photos[0], floor=FLOOR, robot=ROBOT), [], []
    for number, pixels in enumerate(photos[1:], start=1):
        ours = partial(detect, f"{number}", pixels, floor=FLOOR, robot=ROBOT, hint=hint)
        peer = partial(bare.detectMarkers, pixels)
        tries = [(timed(ours), timed(peer)) for _ in range(REPEATS)]
        (*_, seen), (*_, (_, ids, _)) = tries[-1]
        if seen.robot is None or len(seen.floor.pixels) != len(PLACES) or len(ids) != 5:
            raise SystemExit(f"photograph {number}: not all markers are found; nothing to compare")
        rows.append(np.min([[each[:2] for each in one] for one in tries], axis=0))
        found.append(seen)
        hint = seen
    return np.array(rows), found


def in_processes(photos: Sequence[np.ndarray], count: int) -> np.ndarray:
    """Time both with one thread in several processes at once, shape as `side_by_side`.

    Wall time is divided by the processes, which work at the same time but for their start.
    """
    context = multiprocessing.get_context("spawn")  # OpenCV's threads do not survive a fork
    with ProcessPoolExecutor(count, context) as pool:
        every = [pool.submit(_by_one_thread, photos) for _ in range(count)]
        spent = np.mean([each.result() for each in every], axis=0)
    return spent / [1, count]


def _by_one_thread(photos: Sequence[np.ndarray]) -> np.ndarray:
    return side_by_side(photos, 1)[0]


def whole(photos: Sequence[np.ndarray], count: int) -> tuple[float, float]:
    """Time everything from decoded photographs to the smoothed path."""

    def work() -> None:
        """Detect in the photographs, fit the floor, and smooth the path."""
        hint, found = None, []
        for number, pixels in enumerate(photos[:count]):
            hint = detect(f"{number}", pixels, floor=FLOOR, robot=ROBOT, hint=hint)
            found.append(hint)
        fit = refine_floor(LENS, FLOOR, [seen.floor for seen in found])
        times = {f"{number}": (2.0 * number, 0.01) for number in range(count)}
        seen = observe(fit, found, robot=ROBOT, times=times)
        assemble_track(seen, shared=fit.shared, prior=ROBOT.prior)

    return timed(work)[:2]


def smoothing(count: int) -> tuple[float, float]:
    """Time smoothing so many poses, and scipy's smoothing splines of x, y and yaw [s of CPU]."""
    t = np.arange(float(count))
    turned = 0.05 * t
    poses = np.column_stack([np.sin(turned), 1 - np.cos(turned), turned])
    poses += np.random.default_rng(0).normal(0.0, POSE_SD, poses.shape)
    ours = partial(
        smooth, t, poses, covariance=np.tile(np.diag(POSE_SD**2), (count, 1, 1)),
        process=Process(1e-4, 1e-3),
    )  # fmt: skip

    def splines() -> None:
        """Fit a smoothing spline to each of x, y and yaw."""
        for column in poses.T:  # scipy 1.14 fits one column at a time
            make_smoothing_spline(t, column, lam=1.0)

    return min(timed(ours)[0] for _ in range(REPEATS)), min(
        timed(splines)[0] for _ in range(REPEATS)
    )


def main() -> None:
    """Print the tables."""
    print(f"Machine: {describe_machine()}.\n")
    photos = photographs()
    rows, cores = [], cv2.getNumberOfCPUs()
    spent_by = {f"{threads}": side_by_side(photos, threads)[0] for threads in (1, cores)}
    spent_by[f"1, in {WORKERS} processes"] = in_processes(photos, WORKERS)
    for name, ratio_of in spent_by.items():
        (ours, ours_wall), (peer, peer_wall) = np.median(ratio_of, axis=0)
        ratios = ratio_of[:, 0] / ratio_of[:, 1]
        rows.append((
            name, f"{1e3 * ours:.0f}", f"{1e3 * peer:.0f}", f"{np.median(ratios[:, 0]):.2f}",
            f"{1e3 * ours_wall:.0f}", f"{1e3 * peer_wall:.0f}",
            f"{np.median(ratios[:, 1]):.2f}",
        ))  # fmt: skip
    print_table(
        ("12 MP, threads of OpenCV", "detect (CPU ms)", "ArucoDetector (CPU ms)", "ratio",
         "detect (wall ms)", "ArucoDetector (wall ms)", "ratio"),
        *rows,
    )  # fmt: skip
    print(f"Medians over {PHOTOS - 1} photographs of the best of {REPEATS}.\n")
    cv2.setNumThreads(1)
    spent = [(count, *whole(photos, count)) for count in STRETCHES]
    print_table(
        ("photographs to path", "CPU (s)", "wall (s)", "CPU a photograph (s)"),
        *(
            (f"{count}", f"{cpu:.2f}", f"{wall:.2f}", f"{cpu / count:.3f}")
            for count, cpu, wall in spent
        ),
    )
    print("The first photograph of each is searched as a whole.\n")
    smoothing(POSES[0])
    print_table(
        ("poses smoothed", "smooth (CPU ms)", "a pose (CPU us)", "scipy's splines (CPU ms)"),
        *(
            (f"{n}", f"{1e3 * ours:.1f}", f"{1e6 * ours / n:.0f}", f"{1e3 * peer:.1f}")
            for n, (ours, peer) in ((n, smoothing(n)) for n in POSES)
        ),
    )
    print("Cost in proportion to poses; the splines' strength is given, and they know no errors.\n")


if __name__ == "__main__":
    main()
