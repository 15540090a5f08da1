# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab export --to mcap`: write a run, track and prediction to one MCAP file.

| topic | schema | what |
|---|---|---|
| `/legs/joint_states` | sensor_msgs/JointState | leg angles, as recorded or as walked |
| `/tf` | tf2_msgs/TFMessage | `floor` to `tracked`; to `body`, predicted, and its `leg_1` … |
| `/track/path` | nav_msgs/Path | the track |
| `/track/pose` | geometry_msgs/PoseWithCovarianceStamped | its poses with their covariance |
| `/prediction/path` | nav_msgs/Path | the predicted path |
| `/prediction/pose` | geometry_msgs/PoseWithCovarianceStamped | mean and spread of the band |
| `/prediction/draws/1` … | nav_msgs/Path | some of the band's draws |
"""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from model.arrays import Array
from model.path_draws import anchored, mean_path, states_at
from model.poses import Poses
from model.robot import N_LEGS, Robot
from model.walk.path import WalkPath
from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.errors import AlreadyExists, NotFound
from zebro_lab.files.names import PATH_CSV, TRACK
from zebro_lab.files.replacement import recover
from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.ros_messages import JOINT_STATE, Schema, joint_state
from zebro_lab.mcap.ros_poses import (
    PATH,
    POSE,
    TRANSFORMS,
    Transform,
    path,
    pose_with_covariance,
    transforms,
)
from zebro_lab.mcap.stream_views import FASTEST
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.runs.folder import LOG_FILE, epoch_ns
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.recorded_legs import is_recorded, read_recorded_legs
from zebro_lab.track.file import TrackFile, read_track
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.validation.shared_clock import shared_time
from zebro_lab.walk.folder import DRAWS, PREDICTION, read_draws, read_walk, read_walk_manifest
from zebro_lab.walk.prediction_file import robot_of_walk

FLOOR, BODY, TRACKED = "floor", "body", "tracked"
SHOWN_DRAWS = 20  # number of draws of the band that are written, the first ones
FRAMES = 50.0  # largest rate of the predicted robot's poses [Hz]


@dataclass(frozen=True)
class Exported:
    """Summary of an exported MCAP file.

    Attributes:
        file: The written file.
        topics: Number of messages by topic.
        notes: A note on the first that is missing of track, prediction and band; else empty.
    """

    file: Path
    topics: dict[str, int]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Predicted:
    """Prediction of a walk in the floor frame, anchored to the track where one has yaw.

    Attributes:
        walk: Predicted path as written by `predict`, not anchored, with leg angles and height.
        robot: The robot that walked.
        source: Where the leg angles come from.
        path: Predicted path, anchored to the tracked pose.
        draws: Paths of the band, anchored to draws of that uncertain pose; None without a band.
    """

    walk: WalkPath
    robot: Robot
    source: str
    path: Poses
    draws: Poses | None


class _Stamped:
    """Writer of an MCAP log that registers topics at first use; run time [s] to Unix time [ns]."""

    def __init__(self, log: MessageLog, start_ns: int) -> None:
        self._log, self._start = log, start_ns

    def stamps(self, t: Array) -> list[int]:
        return (self._start + np.rint(1e9 * t).astype(np.int64)).tolist()

    def add(self, topic: str, schema: Schema, stamp: int, message: bytes) -> None:
        if topic not in self._log.counts:
            self._log.register(topic, schema)
        self._log.add(topic, stamp, message)


def export_mcap(run: Path, *, out: Path) -> Exported:
    """Write legs, frames, track and predicted band as one MCAP file of ROS 2 messages.

    As in validation, the prediction is anchored at the first tracked pose in its time range.
    Without a track, or with one without yaw, it stays as predicted, from the origin.

    Args:
        run: Run folder, or another folder, with track/ or prediction/ or both. Times of a folder
            without `run.json` are written as seconds since 1970.
        out: File to write, atomically.

    Raises:
        AlreadyExists: `out` exists.
        NotFound: The folder has neither a track nor a prediction, or the prediction's manifest, or
            log or leg profile of the run, is missing.
        DataError: A file is damaged, the run has no leg angles, or fewer than two tracked poses lie
            in the prediction's time range (checked if the track has yaw).
        OSError: The file cannot be written.
    """
    if out.exists():
        raise AlreadyExists(f"{out} exists already; choose another name with --out")
    for part in (TRACK, PREDICTION):
        recover(run / part)
    track = read_track(run / TRACK) if (run / TRACK / TRACK_CSV).is_file() else None
    predicted = _read_predicted(run / PREDICTION, track)
    recorded = read_manifest(run) if is_recorded(run) else None
    if track is None and predicted is None:
        raise NotFound(_nothing_to_add(run, recorded=recorded is not None))
    start = 0 if recorded is None else epoch_ns(recorded.began)
    content = io.BytesIO()
    log = MessageLog(content)
    log.describe("source", {
        "run": recorded.source if recorded else "nothing was recorded here",
        TRACK: track.source if track else "none",
        PREDICTION: predicted.source if predicted else "none",
    })  # fmt: skip
    stamped = _Stamped(log, start)
    _write_legs(stamped, run if recorded else None, predicted)
    if track is not None:
        _write_track(stamped, track)
    if predicted is not None:
        _write_prediction(stamped, predicted)
    log.finish()
    atomic_write_bytes(out, content.getvalue())
    return Exported(out, log.counts, tuple(_notes(run, track, predicted)))


def _nothing_to_add(run: Path, *, recorded: bool) -> str:
    what = f"{run} has neither {TRACK}/{TRACK_CSV} nor {PREDICTION}/{PATH_CSV}"
    then = f"run track --run {run}, or predict {run}, before the export"
    if not recorded:
        return f"{what}; {then}"
    log = run / LOG_FILE
    return f"{what}; {log} is already an MCAP file of what was recorded; for more {then}"


def _read_predicted(folder: Path, track: TrackFile | None) -> _Predicted | None:
    if not (folder / PATH_CSV).is_file():
        return None
    walk = read_walk(folder)
    single = walk.poses.draws()
    draws = read_draws(folder) if (folder / DRAWS).is_file() else None
    if track is not None and track.poses.has_yaw:
        first = int(np.argmax(shared_time(track.poses, walk.poses, file=track.file)))
        at, seen = float(track.poses.t[first]), track.poses
        pose, rng = seen.states[first], np.random.default_rng(1)
        single = anchored(single, pose, at=at, rng=rng)
        if draws is not None:
            spread = track.covariance[first]
            draws = anchored(draws, pose, at=at, covariance=spread, rng=rng)
    manifest = read_walk_manifest(folder)
    source = str(manifest.get("source", "unknown"))
    return _Predicted(walk, robot_of_walk(manifest, folder), source, single.draws(0), draws)


def _write_legs(log: _Stamped, run: Path | None, predicted: _Predicted | None) -> None:
    names = [f"leg_{leg}" for leg in range(1, N_LEGS + 1)]
    if run is not None:
        table, _ = read_recorded_legs(run)
        t = table.columns["t"].to_numpy()
        theta = np.column_stack([table.columns[name].to_numpy() for name in ANGLES])
    elif predicted is not None:
        t, theta = predicted.walk.t, predicted.walk.theta
    else:
        return
    rows = _thinned(t, FASTEST)
    for stamp, angles in zip(log.stamps(t[rows]), theta[rows], strict=True):
        log.add(
            "/legs/joint_states",
            JOINT_STATE,
            stamp,
            joint_state(stamp, names, position=angles.tolist()),
        )


def _write_track(log: _Stamped, track: TrackFile) -> None:
    poses = track.poses
    positions = np.column_stack([poses.position, np.zeros(len(poses))])
    quaternions = _level(np.nan_to_num(poses.yaw))
    stamps = log.stamps(poses.t)
    log.add("/track/path", PATH, stamps[0], path(stamps, FLOOR, positions, quaternions))
    for stamp, position, quaternion, covariance in zip(
        stamps, positions, quaternions, track.covariance, strict=True
    ):
        log.add(
            "/tf",
            TRANSFORMS,
            stamp,
            transforms(stamp, [Transform(FLOOR, TRACKED, position, quaternion)]),
        )
        message = pose_with_covariance(
            stamp, FLOOR, position=position, quaternion=quaternion, covariance=covariance
        )
        log.add("/track/pose", POSE, stamp, message)


def _write_prediction(log: _Stamped, predicted: _Predicted) -> None:
    walk = predicted.walk
    rows = _thinned(walk.t, FRAMES)
    positions = np.column_stack([predicted.path.position[rows], walk.position[rows, 2]])
    turns = np.column_stack([walk.orientation[rows, :2], predicted.path.yaw[rows]])
    quaternions = Rotation.from_euler("ZYX", turns[:, ::-1]).as_quat()
    stamps = log.stamps(walk.t[rows])
    log.add("/prediction/path", PATH, stamps[0], path(stamps, FLOOR, positions, quaternions))
    for row, stamp, position, quaternion in zip(rows, stamps, positions, quaternions, strict=True):
        frames = [Transform(FLOOR, BODY, position, quaternion)]
        frames += _legs(predicted.robot, walk.theta[row])
        log.add("/tf", TRANSFORMS, stamp, transforms(stamp, frames))
    if predicted.draws is not None:
        _write_band(log, predicted.draws, height=float(positions[0, 2]))


def _write_band(log: _Stamped, draws: Poses, *, height: float) -> None:
    mean, stamps = mean_path(draws), log.stamps(draws.t)
    states = states_at(draws, draws.t)
    positions = np.column_stack([mean.position, np.full(len(mean), height)])
    quaternions = _level(mean.yaw)
    for i, stamp in enumerate(stamps):
        message = pose_with_covariance(
            stamp, FLOOR, position=positions[i], quaternion=quaternions[i],
            covariance=np.cov(states[:, i].T),
        )  # fmt: skip
        log.add("/prediction/pose", POSE, stamp, message)
    for i, state in enumerate(states[:SHOWN_DRAWS], 1):
        drawn = np.column_stack([state[:, :2], np.full(len(state), height)])
        message = path(stamps, FLOOR, drawn, _level(state[:, 2]))
        log.add(f"/prediction/draws/{i}", PATH, stamps[0], message)


def _legs(robot: Robot, theta: Array) -> list[Transform]:
    """Return the poses of the hip frames `leg_1` … in the body frame, turned about y by `theta`.

    `theta` are the leg angles, shape (legs,) [rad].
    """
    turned = Rotation.from_euler("y", theta[:, None]).as_quat()
    return [
        Transform(BODY, f"leg_{leg}", hip, quaternion)
        for leg, (hip, quaternion) in enumerate(zip(robot.hips, turned, strict=True), 1)
    ]


def _level(yaw: Array) -> Array:
    return Rotation.from_euler("z", yaw[:, None]).as_quat()


def _thinned(t: Array, rate: float) -> Sequence[int]:
    """Return indices of every k-th row, so that the rate is at most `rate` [Hz], and the last.

    `t` are the rows' times, two or more [s]; their median interval determines k.
    """
    usual = float(np.median(np.diff(t)))
    rows = list(range(0, len(t), max(int(np.ceil(1 / (rate * usual) - 1e-6)), 1)))
    return rows if rows[-1] == len(t) - 1 else [*rows, len(t) - 1]


def _notes(run: Path, track: TrackFile | None, predicted: _Predicted | None) -> list[str]:
    if track is None:
        return [f"without a track: none is in {run / TRACK}; zebro-lab track --run {run} writes it"]
    if predicted is None:
        return [f"without a prediction: zebro-lab predict {run} --out {run / PREDICTION} writes it"]
    if predicted.draws is None:
        return ["without an uncertainty band: zebro-lab predict with --draws 500 writes it"]
    return []
