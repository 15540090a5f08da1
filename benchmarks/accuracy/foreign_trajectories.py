# SPDX-License-Identifier: MIT
"""Errors of public trajectories beside those that the program evo finds, in one table.

FOLDER holds files of `test/data` in evo's source code (github.com/MichaelGrupp/evo, 1.36.5). Both
programs read the files as they are: ours by `zebro-lab validate`, with the options of `PAIRS` and
nothing else; evo by its own readers and its own matching. In space the same files are compared. In
the plane evo is given the poses that `validate` projected and wrote, `reference.tum` and
`estimate.tum`, and its Umeyama alignment gets their x and y alone: in space it may turn a flat path
over. evo keeps rows that repeat a stamp with another pose, of which we keep the first; so
for evo such rows are removed after reading.

Usage: python -m benchmarks.accuracy.foreign_trajectories FOLDER
"""

import copy
import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from evo.core.geometry import umeyama_alignment
from evo.core.metrics import APE, RPE, PoseRelation, StatisticsType, Unit
from evo.core.sync import associate_trajectories
from evo.tools import file_interface
from rosbags.rosbag1 import Reader

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))


def in_bag(topic: str) -> Callable[[str], Any]:
    """Return evo's reader of one topic of a bag of ROS 1."""

    def read(file: str) -> Any:
        with Reader(file) as bag:
            return file_interface.read_bag_trajectory(bag, topic)

    return read


KITTI, TUM, EUROC = (
    file_interface.read_kitti_poses_file,
    file_interface.read_tum_trajectory_file,
    file_interface.read_euroc_csv_trajectory,
)
PAIRS = (  # reference, estimate, evo's readers, distance of the relative error [m], further options
    ("KITTI_00_gt.txt", "KITTI_00_ORB.txt", (KITTI, KITTI), 100.0, ("--plane", "xz")),
    ("KITTI_00_gt.txt", "KITTI_00_SPTAM.txt", (KITTI, KITTI), 100.0, ("--plane", "xz")),
    ("freiburg1_xyz-groundtruth.txt", "freiburg1_xyz-rgbdslam.txt", (TUM, TUM), 0.5, ()),
    ("freiburg1_xyz-groundtruth.txt", "freiburg1_xyz-rgbdslam_drift.txt", (TUM, TUM), 0.5, ()),
    ("freiburg1_xyz-groundtruth.txt", "freiburg1_xyz-ORB_kf_mono.txt", (TUM, TUM), 0.5,
     ("--correct-scale",)),
    ("fr2_desk_groundtruth.txt", "fr2_desk_ORB.txt", (TUM, TUM), 1.0, ()),
    ("fr2_desk_groundtruth.txt", "fr2_desk_ORB_kf_mono.txt", (TUM, TUM), 1.0,
     ("--correct-scale",)),
    ("V102_groundtruth.csv", "V102.txt", (EUROC, TUM), 1.0, ()),
    ("ROS_example.bag", "ROS_example.bag", (in_bag("groundtruth"), in_bag("S-PTAM")), 5.0,
     ("--topic", "groundtruth", "--topic", "S-PTAM")),
)  # fmt: skip


def compare(folder: Path) -> Iterator[tuple[str, str, str, float, float]]:
    """Yield files, space, column, our value and evo's, of all errors of all pairs."""
    for reference, estimate, readers, distance, options in PAIRS:
        files = [folder / reference, folder / estimate]
        with TemporaryDirectory() as out:
            ours = validated(files, Path(out) / "out", ("--distance", distance, *options))
            flat = tuple(
                TUM(str(Path(out) / "out" / f"{name}.tum")) for name in ("reference", "estimate")
            )
        raw = tuple(
            first_of_stamps(read(str(file))) for read, file in zip(readers, files, strict=True)
        )
        if KITTI not in readers:
            raw = associate_trajectories(*raw, max_diff=0.01)
        scale = "--correct-scale" in options
        plane = next(name for name in ours if name != "space")
        yield from beside(estimate, "space", ours["space"], evo_errors(raw, distance, scale))
        yield from beside(estimate, plane, ours[plane], evo_errors(flat, distance))


def validated(files: list[Path], out: Path, options: tuple[object, ...]) -> dict[str, Any]:
    """Run `validate` and return the metrics of its manifest."""
    command = [COMMAND, "validate", *files, "--out", out, *options]
    subprocess.run([str(word) for word in command], check=True, capture_output=True)
    return json.loads((out / "manifest.json").read_text())["metrics"]


def first_of_stamps(path: Any) -> Any:
    """Leave out the poses of one of evo's paths that repeat the stamp before."""
    if hasattr(path, "timestamps"):
        path.reduce_to_ids(np.flatnonzero(np.diff(path.timestamps, prepend=-np.inf) > 0))
    return path


def evo_errors(
    pair: tuple[Any, ...], distance: float, scale: bool | None = None
) -> dict[str, float]:
    """Return evo's errors by column of our `metrics.csv`.

    Args:
        pair: Reference and estimate.
        distance: Distance of the relative error [m].
        scale: Whether evo corrects the scale; None for poses in the plane, which have theirs.
    """
    reference, estimate = pair[0], copy.deepcopy(pair[1])
    if scale:
        estimate.align(reference, correct_only_scale=True, correct_scale=True)

    def rmse(metric: APE | RPE) -> float:
        metric.process_data((reference, estimate))
        return float(metric.get_statistic(StatisticsType.rmse))

    shift, turn = PoseRelation.translation_part, PoseRelation.rotation_angle_deg
    by_path: dict[str, Any] = {"all_pairs": True, "pairs_from_reference": True}
    errors = {
        "poses": float(reference.num_poses),
        "ate_m": rmse(APE(shift)),
        "rotation_rms_deg": rmse(APE(turn)),
        "rpe_step_m": rmse(RPE(shift)),
        "rpe_step_deg": rmse(RPE(turn)),
        f"rpe_{distance:g}m_m": rmse(RPE(shift, distance, Unit.meters, **by_path)),
        f"rpe_{distance:g}m_deg": rmse(RPE(turn, distance, Unit.meters, **by_path)),
    }
    if scale is None:
        return errors | {"ate_aligned_m": aligned_in_plane(reference, estimate)}
    estimate.align(reference)
    return errors | {"ate_aligned_m": rmse(APE(shift))}


def aligned_in_plane(reference: Any, estimate: Any) -> float:
    """Return the root mean square distance after evo's alignment of x and y [m]."""
    x, y = estimate.positions_xyz[:, :2].T, reference.positions_xyz[:, :2].T
    rotation, shift, _ = umeyama_alignment(x, y)
    return float(np.sqrt(np.mean(np.sum((rotation @ x + shift[:, None] - y) ** 2, axis=0))))


def beside(
    name: str, where: str, ours: Mapping[str, float], theirs: Mapping[str, float]
) -> Iterator[tuple[str, str, str, float, float]]:
    """Yield name, space, column, our value and evo's of every error of evo."""
    for column, value in theirs.items():
        yield name, where, column, ours[column], value


def main() -> None:
    """Print the table."""
    worst = 0.0
    print(f"{'estimate':34s} {'in':10s} {'error':18s} {'zebro-lab':>12s} {'evo':>12s}  difference")
    for name, where, column, ours, theirs in compare(Path(sys.argv[1])):
        apart = abs(ours - theirs) / abs(theirs)
        worst = max(worst, apart)
        print(f"{name:34s} {where:10s} {column:18s} {ours:12.6g} {theirs:12.6g}  {apart:.1e}")
    print(f"largest difference: {worst:.1e} of evo's value")


if __name__ == "__main__":
    main()
