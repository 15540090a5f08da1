# SPDX-License-Identifier: MIT
"""Make the simulated walk in this folder: `python datasets/walk-sim/generate.py`.

`generate.py` does all of it and needs MuJoCo (`pip install --group bench`); `generate.py photos`
takes the walk from `truth.csv` and makes the photographs again, without MuJoCo; `generate.py
bench` makes `camera.toml` and `floor.toml` again; `generate.py validate` prints turning radii of
longer, constant walks. Everything follows from `SEED`.
"""

import csv
import hashlib
import sys
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from tracking.floor import FloorMap
from tracking.floor import FloorMarker as MeasuredMarker
from tracking.photos.workers import NoProgress
from zebro_lab.track.camera.request import CameraRequest
from zebro_lab.track.camera.stage import calibrate_camera
from zebro_lab.track.camera_file import CAMERA_FILE
from zebro_lab.track.floor_file import FLOOR_FILE, render_floor_file

sys.path.append(str(Path(__file__).parents[2] / "tests"))
from support.synthetic import (
    Conditions,
    DrawnFloorMarker,
    DrawnPose,
    DrawnRobotMarker,
    DrawnScene,
    RobotLook,
    RobotState,
    Sheet,
    SyntheticPhoto,
    charuco_cells,
    composite,
    develop,
    look_at,
    paint_sheets,
    render_background,
    take_photo,
    with_time_stamp,
)

SEED = 2023
SOURCE = "sim:mujoco-walk"
START = datetime(2020, 6, 1, 12, 0, 0, tzinfo=UTC)  # of the leg log's clock, as the camera has it

STEERING, FRICTION, CYCLE_TIME = 1.2, 0.38, 1.8  # -, -, s
STAND, CYCLES, DURATION = 1.0, 15, 30.2  # s, -, s

COUNTS = 100  # of a leg's encoder in a turn: 3.6 degrees each
LOG_STEP, LOG_JITTER, STAMP_ERROR = 0.02, 0.002, 0.0005  # s
IMU_ANGLE_NOISE, IMU_RATE_NOISE, IMU_RATE_BIAS = 0.002, 0.005, 0.001  # rad, rad/s, rad/s

PHOTO_STEP, PHOTO_JITTER, N_PHOTOS = 2.0, 0.02, 16  # s, s, -
COMPOSITE_PHOTOS = range(1, 14, 2)  # walking; 0.39 m apart, where the body has 0.25 m
MARKER = DrawnRobotMarker(0, 0.12)
CONDITIONS = Conditions(
    exposure_time=1 / 60, defocus_sd_px=0.6, read_noise_counts=1.0, shot_noise_counts=1.5,
    jpeg_quality=85,
)  # fmt: skip
SCENE = DrawnScene(
    look_at(
        (1.0, -1.6, 2.4), (0.85, 0.55, 0.0), width=1600, height=1200,
        field_of_view=np.radians(56.0), distortion=(-0.12, 0.03, 0.0005, -0.0004, 0.0),
    ),
    tuple(
        DrawnFloorMarker(number, centre, 0.15)
        for number, centre in ((10, (0.1, -0.6)), (11, (1.8, -0.6)), (12, (2.2, 1.6)),
                               (13, (-0.5, 1.5)))
    ),
)  # fmt: skip
BOARD = (9, 6)  # squares
SQUARE = 0.04  # m
N_BOARDS = 12

POSE = ("x", "y", "z", "roll", "pitch", "yaw")
LEGS = range(1, 7)


@dataclass(frozen=True)
class Truth:
    """The walk as `truth.csv` has it.

    Attributes:
        t: Shape (n,) [s].
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (n, 6).
        theta: Leg angles, shape (n, 6) [rad].
        yaw_rate: Shape (n,) [rad/s].
    """

    t: np.ndarray
    pose: np.ndarray
    theta: np.ndarray
    yaw_rate: np.ndarray

    def at(self, values: np.ndarray, times: np.ndarray | float) -> np.ndarray:
        """Interpolate columns at some times, shape (..., columns)."""
        return np.stack([np.interp(times, self.t, column) for column in values.T], axis=-1)

    def state(self, time: float) -> RobotState:
        """What the robot does at a time [s]."""
        x, y, z, roll, pitch, yaw = self.at(self.pose, time)
        change = (self.at(self.pose, time + 0.01) - self.at(self.pose, time - 0.01)) / 0.02
        return RobotState(
            DrawnPose(x, y, yaw, z, roll, pitch), tuple(self.at(self.theta, time)),
            (change[0], change[1]), change[5],
        )  # fmt: skip


def walk(folder: Path) -> None:
    """Walk in MuJoCo and write `truth.csv`."""
    import engine  # MuJoCo, which the photographs do without

    tripod = engine.tripod_gait(STEERING, cycle_time=CYCLE_TIME)
    end = CYCLES * CYCLE_TIME

    def gait(t: float) -> tuple[np.ndarray, np.ndarray]:
        angle, rate = tripod(min(max(t - STAND, 0.0), end))
        return angle, rate * (STAND < t < STAND + end)

    made = engine.simulate(gait, duration=DURATION, friction=FRICTION)
    header = ["t", *POSE, "yaw_rate", *(f"theta{i}" for i in LEGS), *(f"normal{i}" for i in LEGS)]
    _table(folder / "truth.csv", header, [
        [f"{t:.2f}", *_fixed(place, 6), *_fixed(angles, 6), f"{rate:.5f}", *_fixed(theta, 5),
         *_fixed(normal, 3)]
        for t, place, angles, rate, theta, normal in zip(
            made.t, made.position, made.roll_pitch_yaw, made.yaw_rate, made.theta,
            made.normal_force, strict=True)
    ])  # fmt: skip
    places, yaw = made.position[:, :2], made.roll_pitch_yaw[:, 2]
    rows = round(CYCLE_TIME / 0.01)
    first, last = round((STAND + 2 * CYCLE_TIME) / 0.01), round((STAND + end) / 0.01)
    chord = np.linalg.norm(np.diff(places[first : last + 1 : rows], axis=0), axis=1)
    turn = np.diff(yaw[first : last + 1 : rows])
    print(f"turning radius {np.mean(chord / (2 * np.sin(turn / 2))):.4f} m")


def validate() -> None:
    """Print the turning radii of constant walks of two seconds a cycle."""
    import engine

    for steering, friction in ((1.2, 0.2), (1.2, 0.38), (1.2, 0.7), (1.3, 0.38)):
        gait = engine.tripod_gait(steering, cycle_time=2.0)
        made = engine.simulate(gait, duration=16.0, friction=friction)
        radius = engine.turning_radius(made, cycle_time=2.0, start=4.0)
        print(f"steering {steering:.1f}, friction {friction:.2f}: radius {radius:.4f} m")


def read_truth(folder: Path) -> Truth:
    """Read `truth.csv`."""
    rows = np.genfromtxt(folder / "truth.csv", delimiter=",", names=True)
    pose = np.column_stack([rows[name] for name in POSE])
    theta = np.column_stack([rows[f"theta{leg}"] for leg in LEGS])
    return Truth(rows["t"], pose, theta, rows["yaw_rate"])


def leg_log(truth: Truth, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Read the legs' encoders.

    Returns:
        The times of a clock that is off by `STAMP_ERROR` each, shape (n,) [s], and whole counts
        since the toe was straight ahead, shape (n, 6).
    """
    taken = np.arange(0.0, 30.0, LOG_STEP)
    taken = np.clip(taken + LOG_JITTER * rng.standard_normal(len(taken)), 0.0, None)
    counts = np.rint(truth.at(truth.theta, taken) / (2 * np.pi) * COUNTS).astype(int)
    stamps = taken + STAMP_ERROR * rng.standard_normal(len(taken))
    return stamps, counts


def write_logs(folder: Path, truth: Truth, rng: np.random.Generator) -> None:
    """Write `legs.csv` and `imu.csv`."""
    stamps, counts = leg_log(truth, rng)
    header = ["t", *(f"theta{leg}" for leg in LEGS), *(f"count{leg}" for leg in LEGS)]
    _table(folder / "legs.csv", header, [
        [f"{t:.5f}", *_fixed(row * 2 * np.pi / COUNTS, 5), *(row % COUNTS)]
        for t, row in zip(stamps, counts, strict=True)
    ])  # fmt: skip
    t = np.arange(0.0, 30.0, LOG_STEP)
    angles = truth.at(truth.pose[:, 3:5], t) + IMU_ANGLE_NOISE * rng.standard_normal((len(t), 2))
    rate = np.interp(t, truth.t, truth.yaw_rate) + IMU_RATE_BIAS
    rate += IMU_RATE_NOISE * rng.standard_normal(len(t))
    _table(folder / "imu.csv", ["t", "roll", "pitch", "yaw_rate"], [
        [f"{time:.2f}", *_fixed(angle, 5), f"{turn:.5f}"]
        for time, angle, turn in zip(t, angles, rate, strict=True)
    ])  # fmt: skip


def photo_times(rng: np.random.Generator) -> np.ndarray:
    """Draw when photographs are taken, to the millisecond, shape (16,) [s]."""
    late = np.abs(PHOTO_JITTER * rng.standard_normal(N_PHOTOS))
    return np.round(PHOTO_STEP * np.arange(N_PHOTOS) + late, 3)


def photographs(truth: Truth, rng: np.random.Generator) -> list[tuple[float, SyntheticPhoto]]:
    """Photograph the walk.

    Returns:
        Each photograph with its time [s].
    """
    background = render_background(SCENE)
    return [
        (time, take_photo(SCENE, truth.state(time), look=RobotLook(MARKER), conditions=CONDITIONS,
                          rng=rng, background=background))
        for time in photo_times(rng).tolist()
    ]  # fmt: skip


def boards(rng: np.random.Generator) -> list[Sheet]:
    """Hold a ChArUco board before the camera, at places that cover the picture."""
    camera, grid = SCENE.camera, charuco_cells(*BOARD)
    size = (BOARD[0] * SQUARE, BOARD[1] * SQUARE)
    held = []
    for index in range(N_BOARDS):
        column, row = index % 4, index // 4
        pixel = ((0.2 + 0.2 * column) * camera.width, (0.22 + 0.28 * row) * camera.height)
        depth = rng.uniform(0.6, 0.95)
        place = depth * camera.rays(pixel)
        tilt = rng.uniform(-0.6, 0.6, 3) * (1.0, 1.0, 0.5)
        turn = DrawnPose(0.0, 0.0, tilt[2], 0.0, tilt[0], tilt[1]).rotation
        facing = turn @ np.diag([1.0, -1.0, -1.0])
        centre = camera.rotation.T @ (place - camera.translation)
        held.append(Sheet(grid, size, centre, camera.rotation.T @ facing))
    return held


def write_photos(folder: Path, truth: Truth, rng: np.random.Generator) -> None:
    """Write the photographs, a composite of them, the boards, and `photos.csv`."""
    for name in ("photos", "composite", "calibration"):
        (folder / name).mkdir(exist_ok=True)
    rows, taken = [], photographs(truth, rng)
    for index, (time, photo) in enumerate(taken):
        name = f"simulated_{index:02d}.jpg"
        stamped = with_time_stamp(photo.jpeg, START + timedelta(seconds=time))
        (folder / "photos" / name).write_bytes(stamped)
        rows.append([name, f"{time:.3f}", *_fixed(truth.at(truth.pose, time), 6)])
    _table(folder / "photos.csv", ["photo", "t", *POSE], rows)
    chosen = [taken[index][1] for index in COMPOSITE_PHOTOS]
    merged = composite(chosen).astype(np.float32) / 255
    picture = folder / "composite" / "simulated_pasted.jpg"
    _write_jpeg(picture, merged, rng, kind=Conditions(
        exposure=1.0, read_noise_counts=0.0, shot_noise_counts=0.0, jpeg_quality=90))  # fmt: skip
    last = START + timedelta(seconds=taken[COMPOSITE_PHOTOS[-1]][0])
    picture.write_bytes(with_time_stamp(picture.read_bytes(), last))
    bare = render_background(replace(SCENE, markers=()))  # their numbers are on the board too
    for index, board in enumerate(boards(rng)):
        seen = paint_sheets(bare, [board], camera=SCENE.camera, light=SCENE.light)
        _write_jpeg(folder / "calibration" / f"simulated_board_{index:02d}.jpg", seen, rng,
                    kind=CONDITIONS)  # fmt: skip


def write_bench(folder: Path) -> None:
    """Write what a lab has before it tracks: `camera.toml` from the boards, and `floor.toml`."""
    board = f"charuco:{BOARD[0]}x{BOARD[1]}:{1e3 * SQUARE:g}mm:{750 * SQUARE:g}mm:4x4_50"
    request = CameraRequest(folder / "calibration", board, folder / CAMERA_FILE)
    calibrate_camera(request, NoProgress())
    (folder / FLOOR_FILE).write_text(floor_toml(), encoding="utf-8")


def floor_toml() -> str:
    """Write the floor's markers as `floor.toml`."""
    laid = tuple(MeasuredMarker(m.marker_id, m.side, *m.centre) for m in SCENE.markers)
    heading = "The SIMULATED floor of this folder, as a tape has it; written by generate.py."
    return render_floor_file(FloorMap("4x4_50", laid), heading=heading)


def _write_jpeg(
    path: Path, picture: np.ndarray, rng: np.random.Generator, *, kind: Conditions
) -> None:
    _, jpeg = develop(picture, kind, rng=rng)
    path.write_bytes(jpeg)


def truth_toml() -> str:
    """Write what the photographs are to be found to have been taken with, as TOML."""
    camera = SCENE.camera
    lines = [
        "# The true values behind this simulated walk; written by generate.py.",
        f'source = "{SOURCE}"', f"seed = {SEED}", f"start = {START.isoformat()}",
        "", "[walk]", f"steering = {STEERING}", f"friction = {FRICTION}",
        "regularisation_speed = 0.001", f"cycle_time = {CYCLE_TIME}",
        "", "[camera]", f"size = {[camera.width, camera.height]}",
        f"focal = {_rounded(camera.focal)}", f"centre = {_rounded(camera.centre)}",
        f"distortion = {list(camera.distortion)}  # k1, k2, p1, p2, k3",
        f"rotation = {_rounded(camera.rotation)}",
        f"translation = {_rounded(camera.translation)}",
        "", "[board]  # ChArUco", f"squares = {list(BOARD)}", f"square = {SQUARE}",
        f"marker = {0.75 * SQUARE}", 'dictionary = "DICT_4X4_50"',
        "", "[robot_marker]", f"id = {MARKER.marker_id}", f"side = {MARKER.side}",
        f'dictionary = "{MARKER.dictionary}"', f"corners_body = {_rounded(MARKER.corners_body)}",
    ]  # fmt: skip
    for marker in SCENE.markers:
        lines += ["", "[[floor_markers]]", f"id = {marker.marker_id}", f"side = {marker.side}",
                  f'dictionary = "{marker.dictionary}"',
                  f"corners = {_rounded(marker.corners)}"]  # fmt: skip
    return "\n".join(lines) + "\n"


def manifest(folder: Path) -> str:
    """Write the SHA-256 of every file below the folder, but for the manifest itself, as TOML."""
    files = sorted(
        path for path in folder.rglob("[!.]*")
        if path.is_file() and path.name != "manifest.toml" and "__pycache__" not in path.parts
    )  # fmt: skip
    hashes = (
        f'"{path.relative_to(folder).as_posix()}" = '
        f'"{hashlib.sha256(path.read_bytes()).hexdigest()}"'
        for path in files
    )
    return "\n".join(["[files]", *hashes]) + "\n"


def write(folder: Path, *, with_walk: bool) -> None:
    """Write every generated file into a folder.

    Args:
        folder: Existing folder; holds `truth.csv` unless the walk is made too.
        with_walk: Whether to make the walk, which needs MuJoCo.
    """
    if with_walk:
        walk(folder)
    truth, rng = read_truth(folder), np.random.default_rng(SEED)
    write_logs(folder, truth, rng)
    write_photos(folder, truth, rng)
    write_bench(folder)
    (folder / "truth.toml").write_text(truth_toml(), encoding="utf-8")
    (folder / "manifest.toml").write_text(manifest(folder), encoding="utf-8")


def _table(path: Path, header: list[str], rows: list[list]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def _fixed(values: np.ndarray, digits: int) -> list[str]:
    return [f"{value:.{digits}f}" for value in values]


def _rounded(values: np.ndarray | tuple[float, ...]) -> list:
    return np.round(np.asarray(values, dtype=float), 9).tolist()


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["validate"]:
            validate()
        case ["bench"]:
            here = Path(__file__).parent
            write_bench(here)
            (here / "manifest.toml").write_text(manifest(here), encoding="utf-8")
        case [] | ["photos"]:
            here = Path(__file__).parent
            write(here, with_walk=len(sys.argv) == 1)
            total = sum(path.stat().st_size for path in here.rglob("*") if path.is_file())
            print(f"{total / 1e6:.1f} MB in {here.name}")
        case other:
            sys.exit(f"{' '.join(other)}: expected nothing, photos, bench or validate")
