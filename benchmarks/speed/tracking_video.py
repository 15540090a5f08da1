# SPDX-License-Identifier: MIT
"""Track thousands of frames of a video by command: time and memory, beside a bare detector.

    python -m benchmarks.speed.tracking_video [FRAMES]

A video is drawn (simulated: four markers on the floor, a marked robot that walks in a circle) and
tracked with `zebro-lab track --every 0`, a tenth of its frames and all. Memory is that of the
largest process. The peer decodes the same video and calls OpenCV's `ArucoDetector` on each frame.
"""

import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np

from benchmarks.machine import describe_machine
from benchmarks.tables import print_table
from support.synthetic import (
    DrawnFloorMarker,
    DrawnPose,
    DrawnScene,
    RobotLook,
    RobotState,
    look_at,
    render_background,
    take_photo,
)

FRAMES = 5000
RATE = 30.0  # frames a second
LAP = 150  # frames of one circle, drawn once
SIZE = (1280, 720)
PLACES = ((0.1, -0.1, 0.3), (1.5, -0.1, -0.4), (1.6, 1.2, 0.5), (0.0, 1.3, -0.2))
SIDE = 0.15
CAMERA = look_at((0.8, -1.2, 1.8), (0.8, 0.6, 0.0), width=SIZE[0], height=SIZE[1])


def draw_lap() -> list[np.ndarray]:
    """Draw the frames of a robot that walks once around a circle to the left."""
    drawn = (DrawnFloorMarker(10 + k, (x, y), SIDE, yaw) for k, (x, y, yaw) in enumerate(PLACES))
    scene = DrawnScene(CAMERA, tuple(drawn))
    background, rng, look = render_background(scene), np.random.default_rng(0), RobotLook()
    frames = []
    for turn in np.linspace(0.0, 2 * np.pi, LAP, endpoint=False):
        x, y = 0.8 + 0.4 * np.sin(turn), 0.6 - 0.4 * np.cos(turn)
        state = RobotState(DrawnPose(float(x), float(y), float(turn)))
        frames.append(take_photo(scene, state, look=look, rng=rng, background=background).pixels)
    return frames


def write_video(path: Path, lap: list[np.ndarray], frames: int) -> None:
    """Write a video of many laps."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), RATE, SIZE)
    if not writer.isOpened():
        raise SystemExit("this OpenCV cannot write MPEG-4 videos; expected opencv-python-headless")
    for number in range(frames):
        writer.write(lap[number % len(lap)])
    writer.release()


def write_settings(folder: Path) -> None:
    """Write what is told of camera, floor and robot."""
    matrix = CAMERA.matrix
    (folder / "camera.toml").write_text(
        f"size = {list(SIZE)}\nfocal = [{matrix[0, 0]}, {matrix[1, 1]}]\n"
        f"centre = [{matrix[0, 2]}, {matrix[1, 2]}]\n"
    )
    lines = [f"side = {SIDE}", "[markers]"]
    lines += [f"{10 + k} = {{ x = {x}, y = {y}, yaw_deg = {np.degrees(yaw)} }}"
              for k, (x, y, yaw) in enumerate(PLACES)]  # fmt: skip
    (folder / "floor.toml").write_text("\n".join(lines) + "\n")
    (folder / "robot.toml").write_text(
        '[marker]\nid = 0\nside = "120 mm"\nposition = [0.0, 0.0, 0.0385]\nheight = 0.103\n'
    )


def tracked(video: Path, out: Path) -> tuple[float, float, int]:
    """Track a video by command: seconds, memory of the largest process [bytes], and poses."""
    began = time.perf_counter()
    command = Path(sys.executable).with_name("zebro-lab")
    process = subprocess.Popen(
        [str(command), "track", str(video), "--camera", "camera.toml", "--floor", "floor.toml",
         "--robot", "robot.toml", "--every", "0", "--out", str(out), "--source", "sim:video",
         "--quiet"],
        cwd=video.parent,
    )  # fmt: skip
    _, status, spent = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"zebro-lab track ended with {os.waitstatus_to_exitcode(status)}")
    poses = len((out / "track.csv").read_text().splitlines()) - 1
    return time.perf_counter() - began, 1024.0 * spent.ru_maxrss, poses


def bare(video: Path) -> float:
    """Time decoding and a bare detector [s]."""
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50))
    capture, began = cv2.VideoCapture(str(video)), time.perf_counter()
    while True:
        more, pixels = capture.read()
        if not more:
            return time.perf_counter() - began
        detector.detectMarkers(pixels)


def main() -> None:
    """Print the table."""
    asked = int(sys.argv[1]) if len(sys.argv) > 1 else FRAMES
    print(f"Machine: {describe_machine()}.\n")
    lap, rows = draw_lap(), []
    with TemporaryDirectory() as name:
        folder = Path(name)
        write_settings(folder)
        for frames in (asked // 10, asked):
            video = folder / f"walk{frames}.mp4"
            write_video(video, lap, frames)
            seconds, memory, poses = tracked(video, folder / f"track{frames}")
            peer = bare(video)
            rows.append((
                f"{frames}", f"{poses}", f"{seconds:.0f}", f"{1e3 * seconds / frames:.1f}",
                f"{1e3 * peer / frames:.1f}", f"{memory / 1e6:.0f}",
            ))  # fmt: skip
    print_table(
        ("frames", "poses", "track (s)", "a frame (ms)", "decode and ArucoDetector (ms)",
         "memory (MB)"),
        *rows,
    )  # fmt: skip
    print(f"{SIZE[0]} x {SIZE[1]} px, wall time; tracking includes smoothing and pictures.\n")


if __name__ == "__main__":
    main()
