# SPDX-License-Identifier: MIT
"""Walks of an independent engine as a lab has them: counted legs, and a track with noise."""

import os
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.accuracy.engine_walks import SHARED, EngineWalk, radius, read_walk
from model.bayes.walks.fit import WalkFit
from model.bayes.walks.posterior import WalkPosterior
from model.bayes.walks.prior import WalkPrior
from model.bayes.walks.tilt import MeasuredTilt
from model.gait.reference import SampledReference
from model.robot import N_LEGS, Robot
from zebro_lab.calibration.slip_argument import NamedSlip, parse_slip
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile, render_robot_file
from zebro_lab.validation.judged_run import JudgedRun, judge_run
from zebro_lab.walk_fit.prediction import fit_walks_on_file, predict_from
from zebro_lab.walk_fit.tracked_walks import WalkOnFile, read_walk_on_file
from zebro_lab.workers.choice import cores_of
from zebro_lab.workers.request import CoresRequest

ENGINE = Path(__file__).parents[2] / "datasets" / "walk-sim"
KEPT = Path(os.environ.get("ZEBRO_LAB_SCRATCH", tempfile.gettempdir())) / "walks-with-a-leg-off"
STEP = np.radians(3.6)  # of the legs' encoders
EVERY = 2.0  # s between photographs
NOISE = np.array(
    [0.002, 0.002, np.radians(0.3)]
)  # x, y, yaw; those of docs/tracking.md are smaller
IMU_NOISE, MOUNTED = np.radians(0.3), np.radians([0.8, -1.2])  # of roll and pitch
TRACKS = 20  # of other noise, that judge a prediction
BENT_STEERING, BENT_CYCLE, BENT_DURATION = 1.2, 2.0, 16.0  # of those walks: -, s, s


@dataclass(frozen=True)
class Scored:
    """A walk predicted and compared.

    Attributes:
        walk: The engine's walk.
        informed_by: What informed the fit.
        judged: The prediction judged against the track.
        tracks: The same against tracks of other noise, the first included.
    """

    walk: EngineWalk
    informed_by: str
    judged: JudgedRun
    tracks: tuple[JudgedRun, ...]

    @property
    def turn_error(self) -> tuple[float, str]:
        """Relative error of the radius, or for a straight walk that of yaw rate [deg/s]."""
        path, truth = self.judged.rows[0].path, self.walk.truth
        t, yaw, xy = (truth[c].to_numpy() for c in ("t", "yaw", ["x", "y"]))
        theirs = radius(t, xy, yaw, self.walk.period)
        if abs(theirs) > 5.0:
            ends = np.array([self.walk.period, t[-1]])
            rates = [
                np.degrees(np.diff(np.interp(ends, times, angles))[0] / np.ptp(ends))
                for times, angles in ((path.t, path.yaw), (t, yaw))
            ]
            return float(rates[0] - rates[1]), "deg/s"
        at = np.clip(t, path.t[0], path.t[-1])
        walked = path.at(at)
        heading = np.interp(at, path.t, path.yaw)
        return radius(at, walked.position, heading, self.walk.period) / theirs - 1, "of radius"


def write_walk(folder: Path, walk: EngineWalk, *, seed: int, counted: bool = True) -> WalkOnFile:
    """Write a walk as a lab would have it and read it back.

    Args:
        folder: Where to.
        walk: The engine's walk.
        seed: Of the tracker's noise.
        counted: Whether leg angles are counted in steps of `STEP`; else they are the engine's.
    """
    theta = STEP * np.round(walk.log.theta / STEP) if counted else walk.log.theta
    rng = np.random.default_rng(seed)
    seen = np.arange(0.0, walk.duration + 1e-9, EVERY)
    truth = [np.interp(seen, walk.truth["t"], walk.truth[c]) for c in ("x", "y", "yaw")]
    x, y, yaw = np.column_stack(truth).T + (rng.normal(size=(len(seen), 3)) * NOISE).T
    (folder / "track").mkdir(parents=True)
    pd.DataFrame({"t": walk.log.t} | {f"theta{i + 1}": theta[:, i] for i in range(6)}).to_csv(
        folder / "legs.csv", index=False
    )
    covariance = dict(zip(("cov_xx", "cov_yy", "cov_yawyaw"), NOISE**2, strict=True))
    pd.DataFrame({
        "t_s": seen, "x_m": x, "y_m": y, "yaw_rad": yaw, **covariance,
        "cov_xy": 0.0, "cov_xyaw": 0.0, "cov_yyaw": 0.0,
    }).to_csv(folder / "track" / "track.csv", index=False)  # fmt: skip
    (folder / ROBOT_FILE).write_text(render_robot_file(RobotFile(walk.robot)))
    return read_walk_on_file(folder)


def simulate_bent(leg: int, angle: float) -> pd.DataFrame:
    """Walk in MuJoCo with one leg ahead of its log by an angle [rad]."""
    sys.path.append(str(ENGINE))
    import engine  # pyright: ignore[reportMissingImports]

    gait = engine.tripod_gait(BENT_STEERING, cycle_time=BENT_CYCLE)
    ahead = angle * np.eye(N_LEGS)[leg]
    walk = engine.simulate(
        lambda t: (gait(t)[0] + ahead, gait(t)[1]), duration=BENT_DURATION, friction=0.38
    )
    x, y = walk.position[:, :2].T
    logged = {f"th{i + 1}": angles for i, angles in enumerate((walk.theta - ahead).T)}
    roll, pitch, yaw = walk.roll_pitch_yaw.T
    states = {"t": walk.t, "x": x, "y": y, "yaw": yaw, "roll": roll, "pitch": pitch}
    return pd.DataFrame(states | logged)


class Bench:
    """All walks as a lab has them, counted or with the engine's leg angles; the calibration."""

    def __init__(self, calibration: Path, scratch: Path, *, counted: bool = True) -> None:
        self.counted = counted
        self.slip: NamedSlip = parse_slip(str(calibration))
        self._scratch = scratch
        self.engine = {
            file.stem: read_walk(file)
            for file in sorted((SHARED / "virtual-world" / "walks").glob("*.json"))
        }

    def walk(self, name: str, *, again: int = 0) -> WalkOnFile:
        """Return a walk as a lab has it; tracked `again` with other noise."""
        folder = self._scratch / f"{name}-{again}"
        if not folder.exists():
            seed = 100 + sorted(self.engine).index(name) + 1000 * again
            return write_walk(folder, self.engine[name], seed=seed, counted=self.counted)
        return read_walk_on_file(folder)

    def bent(self, leg: int, degrees: float) -> str:
        """Let the engine walk with a leg off by an angle that its log does not know; name it."""
        name = f"s{BENT_STEERING:.2f}_leg{leg + 1}_{degrees:+g}"
        file = KEPT / f"{name}.csv"
        if not file.is_file():
            KEPT.mkdir(parents=True, exist_ok=True)
            simulate_bent(leg, np.radians(degrees)).to_csv(file, index=False)
        truth = pd.read_csv(file)
        theta = truth[[f"th{i}" for i in range(1, 7)]].to_numpy()
        log = SampledReference(truth["t"].to_numpy(), theta)
        self.engine[name] = EngineWalk(name, Robot(), log, 0.38, True, BENT_CYCLE, truth)
        return name

    def with_imu(self, name: str) -> WalkOnFile:
        """Return a walk with roll and pitch, of noise and of a unit mounted off by `MOUNTED`."""
        truth = self.engine[name].truth
        rng = np.random.default_rng(200 + len(name))
        angles = truth[["roll", "pitch"]].to_numpy() + MOUNTED
        angles += IMU_NOISE * rng.standard_normal(angles.shape)
        return replace(self.walk(name), tilt=MeasuredTilt(truth["t"].to_numpy(), angles))

    def fit(self, walks: Sequence[WalkOnFile]) -> WalkFit:
        """Fit walks, and say how long it took."""
        began = time.monotonic()
        fit = fit_walks_on_file(
            walks,
            self.slip,
            prior=WalkPrior(),
            rng=np.random.default_rng(1),
            mapper=cores_of(CoresRequest()),
        )
        note = f"{len(walks)} walks fitted in {time.monotonic() - began:.0f} s"
        print(f"{note}, {fit.posterior.effective:.0f} effective draws", file=sys.stderr)
        return fit

    def score(
        self, posterior: WalkPosterior, walk: WalkOnFile, name: str, informed_by: str,
        *, index: int | None = None,
    ) -> Scored:  # fmt: skip
        """Predict a walk from a posterior and judge it by tracks of other noise."""
        rng = np.random.default_rng(2)
        prediction = predict_from(posterior, walk, self.slip, rng=rng, index=index)
        seen = [walk, *(self.walk(name, again=i) for i in range(1, TRACKS))]
        judged = [
            judge_run(each.name, prediction, each.track, anchor=True, rng=rng) for each in seen
        ]
        return Scored(self.engine[name], informed_by, judged[0], tuple(judged))


def short(name: str) -> str:
    """Shorten a walk's name."""
    return name.removeprefix("tripod_").removesuffix("_tc2").replace("_mu0.38", "")
