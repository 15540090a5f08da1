# SPDX-License-Identifier: MIT
"""The virtual world's photographs through the commands, against the truth they were drawn from."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tracking.camera import Camera, CameraPose, project
from tracking.pose import rotation_with_derivatives
from zebro_lab.track.file import read_track

pytestmark = pytest.mark.reference


@pytest.fixture
def world(shared) -> dict:
    return json.loads((shared / "virtual-world/photos/camera.json").read_text())


@pytest.fixture
def lab(world, tmp_path, monkeypatch) -> Path:
    """Return a folder to work in, with the world's camera.json as the files that `track` takes."""
    K = world["K"]
    (tmp_path / "camera.toml").write_text(
        f"size = {world['image_size']}\nfocal = [{K[0][0]}, {K[1][1]}]\n"
        f"centre = [{K[0][2]}, {K[1][2]}]\n"
    )
    lines = ["[markers]"]
    for key, marker in world["floor_markers"].items():
        corners = np.array(marker["corners_world"])
        (x, y, z), (ax, ay, _) = corners.mean(axis=0), corners[1] - corners[0]
        yaw = np.degrees(np.arctan2(ay, ax))
        lines.append(
            f"{key} = {{ x = {x}, y = {y}, z = {z}, yaw_deg = {yaw}, side = {marker['side']} }}"
        )
    (tmp_path / "floor.toml").write_text("\n".join(lines))
    top = world["top_marker"]
    x, y, z = np.mean(top["corners_body"], axis=0)
    (tmp_path / "robot.toml").write_text(
        f'[marker]\ndictionary = "{top["dict"]}"\nid = {top["id"]}\nside = {top["side"]}\n'
        f"position = [{x}, {y}, {z}]\nheight = 0.1\n"
    )
    monkeypatch.setattr("zebro_lab.track.pictures.draw_track", lambda *_, **__: None)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def track(run_command, photos: Path, *options: object) -> np.ndarray:
    """Track and return x, y [m] and yaw [rad] of every photograph."""
    ended = run_command(
        "track", photos, "--camera", "camera.toml", "--floor", "floor.toml", "--robot",
        "robot.toml", "--interval", 2, "--source", "sim:virtual-world", "--out", "out",
        *options,
    )  # fmt: skip
    assert ended.code == 0
    table = pd.read_csv("out/track.csv")
    assert len(table) == len(list(photos.glob("*.jpg")))
    return table[["x_m", "y_m", "yaw_rad"]].to_numpy()


def read_truth(photos: Path) -> np.ndarray:
    with (photos / "truth.csv").open(encoding="utf-8") as file:
        names = ("x", "y", "z", "roll", "pitch", "yaw")
        return np.array([[float(row[name]) for name in names] for row in csv.DictReader(file)])


def assert_within(poses: np.ndarray, truth: np.ndarray, metres: float, degrees: float) -> None:
    error = np.abs(poses - truth[:, [0, 1, 5]])
    distance, turn = np.hypot(*error[:, :2].T), np.degrees(error[:, 2])
    rms, worst = (1e3 * how(distance) for how in (_rms, np.max))
    print(  # noqa: T201 docs/tracking.md quotes it
        f"distance rms {rms:.2f} mm, largest {worst:.2f} mm; yaw rms {_rms(turn):.3f} deg, "
        f"largest {turn.max():.3f} deg"
    )
    assert distance.max() < metres
    assert turn.max() < degrees


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def by_covariance(poses: np.ndarray, truth: np.ndarray) -> tuple[float, np.ndarray]:
    """Compute the joint NEES per degree of freedom, and the rms of x, y, yaw by their sd, (3,)."""
    error, joint = poses - truth[:, [0, 1, 5]], read_track(Path("out")).joint
    assert joint is not None
    together = error.ravel() @ np.linalg.solve(joint.dense, error.ravel()) / error.size
    sd = np.sqrt(np.diagonal(joint.marginal, axis1=1, axis2=2))
    return float(together), np.sqrt(np.mean((error / sd) ** 2, axis=0))


@pytest.mark.parametrize("letter", ["A", pytest.param("C", marks=pytest.mark.long)])
def test_marked_walks_are_within_three_millimetres(letter, lab, shared, run_command):
    photos = shared / f"virtual-world/photos/s1.10_{letter}"
    poses, truth = track(run_command, photos), read_truth(photos)
    assert_within(poses, truth, 3e-3, 0.3)
    together, ratios = by_covariance(poses, truth)
    print(f"joint NEES {together:.2f}, error by sd {ratios.round(2)}")  # noqa: T201
    assert together < 1.5


def track_clicked(run_command, photos: Path, world: dict, *, photo: int, seed: int) -> np.ndarray:
    """Click on the robot's top in a photograph, and track it by that; return x, y and yaw."""
    Path("annotations.toml").unlink(missing_ok=True)
    name = sorted(path.name for path in photos.glob("*.jpg"))[photo]
    clicks = clicked(world, read_truth(photos)[photo], seed=seed)
    told = ("--corners", clicks, "--plate", "150mmx150mm@38.5mm")
    assert run_command("annotate", photos, "--photo", name, *told).code == 0
    return track(run_command, photos, "--without-marker", "--annotations", "annotations.toml")


def test_the_unmarked_walk_is_within_five_millimetres(lab, world, shared, run_command):
    photos = shared / "virtual-world/photos/s1.10_B"
    poses = track_clicked(run_command, photos, world, photo=7, seed=0)
    assert_within(poses, read_truth(photos), 5e-3, 2.0)


@pytest.mark.long
@pytest.mark.parametrize("letter", ["B", "D"])
def test_most_clicks_bring_unmarked_walks_within_five_millimetres(
    letter, lab, world, shared, run_command
):
    photos = shared / f"virtual-world/photos/s1.10_{letter}"
    truth, rows = read_truth(photos), []
    for seed in range(20):
        poses = track_clicked(run_command, photos, world, photo=7, seed=seed)
        error = np.abs(poses - truth[:, [0, 1, 5]])
        together, ratios = by_covariance(poses, truth)
        largest = 1e3 * np.hypot(*error[:, :2].T).max(), np.degrees(error[:, 2].max())
        rows.append((*largest, together, *ratios))
    median, most = np.median(rows, axis=0), np.max(rows, axis=0)
    rms = np.sqrt(np.mean(np.square(rows), axis=0))[3:]
    print(  # noqa: T201
        f"{letter}: largest error {median[0]:.2f} mm, {median[1]:.2f} deg (median), {most[0]:.2f} "
        f"mm, {most[1]:.2f} deg (most); joint NEES {median[2]:.2f} (median), {most[2]:.2f} (most); "
        f"error by sd of x, y, yaw {rms.round(2)}"
    )
    assert median[0] < 5.0
    assert median[1] < 1.0
    assert median[2] < 1.5
    assert (rms < 1.5).all()


@pytest.mark.long
def test_a_second_annotated_photograph_makes_an_unmarked_walk_surer_and_edges_more(
    lab, world, shared, run_command
):
    photos = shared / "virtual-world/photos/s1.10_D"
    truth, names = read_truth(photos), sorted(path.name for path in photos.glob("*.jpg"))
    annotations = Path("annotations.toml")

    def annotate(number: int) -> None:
        corners = ("--corners", clicked(world, truth[number], seed=number))
        told = (*corners, "--plate", "150mmx150mm@38.5mm")
        assert run_command("annotate", photos, "--photo", names[number], *told).code == 0

    def tracked(edges: str) -> tuple[float, str]:
        said = annotations.read_text()
        annotations.write_text(re.sub("edges = (true|false)", f"edges = {edges}", said))
        ended = run_command(
            "track", photos, "--camera", "camera.toml", "--floor", "floor.toml", "--robot",
            "robot.toml", "--interval", 2, "--source", "sim:virtual-world", "--out", "out",
            "--without-marker", "--annotations", "annotations.toml",
        )  # fmt: skip
        assert ended.code == 0
        table = pd.read_csv("out/track.csv")
        assert_within(table[["x_m", "y_m", "yaw_rad"]].to_numpy(), truth, 5e-3, 1.0)
        return float(np.sqrt(table["cov_yawyaw"]).median()), ended.out

    annotate(7)
    by_edges, said = tracked("true")
    assert f"{names[7]}: 4 of 4 edges" in said
    once, said = tracked("false")
    assert by_edges < 0.5 * once
    annotate(2)
    twice, _ = tracked("false")
    assert twice < 0.95 * once
    assert annotations.read_text().count("[[template]]") == 2


def clicked(world: dict, pose: np.ndarray, seed: int = 0) -> str:
    """Click on the corners of the robot's top as a person would, to a third of a pixel."""
    R, _ = rotation_with_derivatives(*pose[3:])
    top = np.array([[75, 75, 38.5], [75, -75, 38.5], [-75, -75, 38.5], [-75, 75, 38.5]]) / 1e3
    lens = Camera(tuple(world["image_size"]), np.array(world["K"]), np.zeros(5))
    clicks = project(lens, CameraPose.from_matrix(world["R"], world["t"]), top @ R.T + pose[:3])
    clicks += np.random.default_rng(seed).normal(0, 0.3, clicks.shape)
    return " ".join(f"{u:.1f},{v:.1f}" for u, v in clicks)
