# SPDX-License-Identifier: MIT
"""Predict paths with uncertainty from a robot, its leg log and its slip law.

Four uncertainties spread a path: the slip law's posterior; the legs' angles (each leg's constant
offset, and the angle between two counts of a coarse encoder); the pose it starts from; and the
error of the walking model, stated here as an error of distance and one of curvature.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from model.errors import DomainError
from model.gait.quantised import QuantisedLog
from model.gait.reference import LegReference
from model.poses import Poses, moved_onto
from model.robot import N_LEGS, Robot
from model.slip.law import Array
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.path import WalkPath
from model.walk.traction import TractionTable

STEPS = (0.005, 0.0025, 0.00125)  # s; an ensemble uses the largest that has converged
SAME_PATH = 0.005  # of the path's length: mean distance of ends at one step and at half of it
COMPARED, COMPARED_TIMES = 8, 101  # draws, and their poses, that are compared to choose the step
LEVELS = (0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975)
STATES = ("x", "y", "yaw")
FINE = DynamicsOptions(dt=0.001)  # of the single path; with a wrong leg its turn is within 1 %
MOST_MOTIONS = 300  # a motion costs as much as its walk, and contributes least to the spread
ARCS = (np.pi / 2, np.radians(359.0))  # a robot's legs are arcs of these angles


@dataclass(frozen=True)
class ModelSpread:
    """Error of the walking model, constant along a walk.

    Stiffness and damping of the contacts matter for gaits that stand on more legs than statics can
    load, or whose legs take over at unequal heights, and hardly for others. They are therefore
    drawn. `distance` and `curvature`, the same for every gait, are root mean squares of the
    differences from an independent engine's walks.

    Attributes:
        distance: Relative error of distance, standard deviation [-].
        curvature: Error of curvature, standard deviation [rad/m].
        contacts: Standard deviation of the logarithms of the contacts' stiffness and damping [-].
    """

    distance: float = 0.003
    curvature: float = 0.004
    contacts: float = float(np.log(2.0))

    def __post_init__(self) -> None:
        """Check that the standard deviations are finite and not negative."""
        for name in ("distance", "curvature", "contacts"):
            if not (getattr(self, name) >= 0 and np.isfinite(getattr(self, name))):
                raise DomainError(f"{name} of the model's error is {getattr(self, name):g}")


@dataclass(frozen=True)
class LegState:
    """Draws of what differs from the description of the robot and the slip law.

    They come from a prior or a posterior.

    Attributes:
        offset: Further offset of each leg, shape (m, 6) [rad].
        grip: Factor on traction, shape (m,) [-].
        stiffness: Factor on slip stiffness, shape (m,) [-].
        fall: Factor on the post-peak drop, shape (m,) [-].
        arc: Further angle of the legs' arc, shape (m,) [rad].
        steering: Constant curvature added to the path, whatever the legs do, shape (m,) [rad/m].
        stride: Relative error of distance: legs that are longer or shorter, shape (m,) [-].
    """

    offset: Array
    grip: Array
    stiffness: Array
    fall: Array
    arc: Array
    steering: Array
    stride: Array

    def __len__(self) -> int:
        """Return the number of draws."""
        return len(self.grip)

    @staticmethod
    def of_prior(n: int, *, offset_sd: float, rng: np.random.Generator) -> "LegState":
        """Draw leg offsets from a uniform prior, with every other unknown at its described value.

        An encoder's zero known to one count is uniform over it: standard deviation count/sqrt(12).

        Args:
            n: Number of draws.
            offset_sd: Standard deviation of an offset [rad].
            rng: Source of randomness.
        """
        reach = np.sqrt(3.0) * offset_sd
        offset = rng.uniform(-reach, reach, (n, N_LEGS))
        one, no = np.ones(n), np.zeros(n)
        return LegState(offset, one, one, one, no, no, no)


def scaled_table(
    table: TractionTable, *, grip: float, stiffness: float, fall: float = 1.0
) -> TractionTable:
    """Scale a law's traction and, independently, its slip stiffness and its post-peak drop.

    A rig measures the post-peak drop under legs that slide for seconds. A walking leg lifts off
    earlier, and its slip is a velocity as much as a ratio. The post-peak drop is therefore the part
    of a law that applies least to a walk.

    Args:
        table: The law.
        grip: Factor on traction at large slip [-].
        stiffness: Factor on traction per slip at zero slip [-].
        fall: Factor on the post-peak drop; there is none at zero [-].
    """
    table = _with_fall(table, fall)
    shrink = stiffness / grip
    return table._replace(
        phi=table.phi * grip,
        slope=table.slope * grip,
        toe=table.toe * grip,
        scale=table.scale if table.by_velocity else table.scale / shrink,
        speed_scale=table.speed_scale / shrink,
    )


def _with_fall(table: TractionTable, fall: float) -> TractionTable:
    top = table.phi.max(axis=1)
    beyond = np.arange(table.phi.shape[1]) >= table.phi.argmax(axis=1)[:, None]
    phi = np.where(beyond, top[:, None] - fall * (top[:, None] - table.phi), table.phi)
    slope = np.where(beyond, fall * table.slope, table.slope)
    return table._replace(phi=phi, slope=slope, toe=top - fall * (top - table.toe))


def walk_draws(
    robot: Robot,
    legs: LegReference | QuantisedLog,
    tables: Sequence[TractionTable],
    state: LegState,
    *,
    rng: np.random.Generator,
) -> list[WalkDraw]:
    """Combine draws of the law, of the legs' state and of their motion, one path each.

    Args:
        robot: The robot as described.
        legs: Its leg angles from time zero on; a quantised log is reconstructed anew for each of
            the first `MOST_MOTIONS` draws, and they are taken in turn.
        tables: Draws of the slip law, taken in turn.
        state: Draws of the legs' state; their number is the ensemble's.
        rng: Source of randomness.
    """
    motions = _motions(legs, min(len(state), MOST_MOTIONS), rng)
    return [
        WalkDraw(
            robot_in(robot, state, i),
            motions[i % len(motions)],
            law_in(tables[i % len(tables)], state, i),
        )
        for i in range(len(state))
    ]


def _motions(
    legs: LegReference | QuantisedLog, n: int, rng: np.random.Generator
) -> Sequence[LegReference]:
    return [legs.smooth(rng) for _ in range(n)] if isinstance(legs, QuantisedLog) else [legs]


def robot_in(robot: Robot, state: LegState, i: int) -> Robot:
    """Return the robot with the leg offsets and arc of one draw.

    Args:
        robot: The robot as described.
        state: Draws of the legs' state.
        i: Index of the draw.
    """
    return replace(
        robot,
        leg_offset=robot.leg_offset + state.offset[i],
        leg_arc=float(np.clip(robot.leg_arc + state.arc[i], *ARCS)),
    )


def law_in(table: TractionTable, state: LegState, i: int) -> TractionTable:
    """Return the slip law scaled by the grip, slip stiffness and post-peak drop of one draw.

    Args:
        table: The slip law as calibrated.
        state: Draws of the legs' state.
        i: Index of the draw.
    """
    return scaled_table(
        table,
        grip=float(state.grip[i]),
        stiffness=float(state.stiffness[i]),
        fall=float(state.fall[i]),
    )


def ensemble_step(
    draws: Sequence[WalkDraw], *, duration: float, threads: int = 2
) -> DynamicsOptions:
    """Choose the largest time step at which the mean of the walks' ends has converged.

    The error of a step differs from path to path, 0.3 % of its length at 5 ms, which is small
    against the spread of the draws. An error that all paths share is not, so the means of some ends
    are compared with those at half the step. At 5 ms a tripod's is within 0.2 % of the path. Where
    four legs are on the ground and loads oscillate between them, 5 ms shifts it by 7 %.

    Args:
        draws: The ensemble, of which the first `COMPARED` are walked.
        duration: Time walked [s].
        threads: Number of draws walked at once.

    Raises:
        WalkError: A walk diverged.
    """
    t = np.linspace(0.0, max(duration, STEPS[0]), COMPARED_TIMES)
    means: dict[float, Array] = {}
    for dt in STEPS:
        options = DynamicsOptions(dt=dt)
        paths = walk_ensemble(draws[:COMPARED], t, options=options, threads=threads).poses
        means[dt] = paths.position[:, -1].mean(axis=0)
        length = np.linalg.norm(np.diff(paths.position, axis=1), axis=2).sum(axis=1).mean()
        larger = 2 * dt
        if larger in means and np.linalg.norm(means[dt] - means[larger]) <= SAME_PATH * length:
            return DynamicsOptions(dt=larger)
    return DynamicsOptions(dt=STEPS[-1])


def predict_paths(
    draws: Sequence[WalkDraw],
    t: Array,
    *,
    state: LegState,
    error: ModelSpread,
    rng: np.random.Generator,
    threads: int = 2,
    options: DynamicsOptions | None = None,
    progress: Callable[[float], None] | None = None,
) -> Poses:
    """Walk every draw and add its steering, its stride and a draw of the model's error.

    Args:
        draws: The draws to walk.
        t: Times of the poses, increasing from zero, shape (n,) [s].
        state: The legs' state of each draw.
        error: Error of the walking model.
        rng: Source of randomness.
        threads: Number of draws walked at once.
        options: How walks are computed; when None the step is chosen by `ensemble_step`.
        progress: Called with the fraction done.

    Raises:
        WalkError: A walk diverged.
    """
    draws = with_contacts(draws, error, rng=rng)
    if options is None:
        options = ensemble_step(draws, duration=float(t[-1]), threads=threads)
    walked = walk_ensemble(draws, t, options=options, threads=threads, progress=progress).poses
    n = len(draws)
    return bent(
        walked,
        distance=state.stride + error.distance * rng.standard_normal(n),
        curvature=state.steering + error.curvature * rng.standard_normal(n),
    )


def with_contacts(
    draws: Sequence[WalkDraw], error: ModelSpread, *, rng: np.random.Generator
) -> list[WalkDraw]:
    """Draw the stiffness and damping of the contacts of each draw, log-normal.

    Args:
        draws: The draws.
        error: Error of the walking model; without spread of contacts the draws are returned as
            they are.
        rng: Source of randomness.
    """
    if error.contacts == 0:
        return list(draws)
    factors = np.exp(error.contacts * rng.standard_normal((len(draws), 2)))
    return [
        replace(draw, stiffness=float(stiffness), damping=float(damping))
        for draw, (stiffness, damping) in zip(draws, factors, strict=True)
    ]


def bent(paths: Poses, *, distance: Array, curvature: Array) -> Poses:
    r"""Stretch and bend paths: :math:`d s' = (1 + \epsilon) ds, \; d\psi' = d\psi + \kappa\, ds`.

    Args:
        paths: Paths of m draws.
        distance: Relative error of distance of each, shape (m,) [-].
        curvature: Curvature added to each, shape (m,) [rad/m].
    """
    step = np.diff(paths.position, axis=1)
    forward = step[..., 0] + 1j * step[..., 1]
    travelled = _from_zero(np.abs(forward))
    turned = curvature[:, None] * travelled
    middle = 0.5 * (turned[:, 1:] + turned[:, :-1])
    steps = (1 + distance[:, None]) * forward * np.exp(1j * middle)
    moved = np.stack([_from_zero(np.real(steps)), _from_zero(np.imag(steps))], axis=-1)
    position = paths.position[:, :1] + moved
    return Poses(paths.t, position, paths.yaw + turned)


def bent_walk(path: WalkPath, *, distance: float, curvature: float) -> WalkPath:
    """Stretch and bend one walked path as `bent` does; slip and forces in its heading frame stay.

    Args:
        path: The path.
        distance: Relative error of distance [-].
        curvature: Curvature added [rad/m].
    """
    one = path.poses.draws()
    moved = bent(one, distance=np.array([distance]), curvature=np.array([curvature]))
    return replace(
        path,
        position=np.column_stack([moved.position[0], path.position[:, 2]]),
        orientation=np.column_stack([path.orientation[:, :2], moved.yaw[0]]),
    )


def anchored(
    paths: Poses,
    pose: Array,
    *,
    at: float,
    covariance: Array | None = None,
    rng: np.random.Generator,
) -> Poses:
    """Move every path rigidly so that it passes a known pose, or a draw of an uncertain one.

    Args:
        paths: Paths.
        pose: x, y [m] and yaw [rad] at that time, shape (3,).
        at: The time, within the paths' [s].
        covariance: Covariance of the pose, shape (3, 3); None when it is exact.
        rng: Source of randomness.

    Raises:
        DomainError: The time lies outside the paths'.
    """
    if not paths.t[0] <= at <= paths.t[-1]:
        raise DomainError(
            f"the known pose is of {at:g} s, but paths run from {paths.t[0]:g} to {paths.t[-1]:g} s"
        )
    here = states_at(paths, np.array([at]))[:, 0]
    wanted = pose
    if covariance is not None:
        wanted = rng.multivariate_normal(pose, covariance, size=len(here), method="eigh")
    return Poses.of_states(paths.t, moved_onto(paths.states, here, wanted))


def states_at(paths: Poses, t: Array) -> Array:
    """Interpolate x, y and yaw of every draw linearly at given times.

    Args:
        paths: The draws.
        t: Times, shape (k,) [s]; outside the paths the ends are extrapolated.

    Returns:
        States, shape (draws, k, 3) [m, m, rad].
    """
    values = paths.states
    after = np.clip(np.searchsorted(paths.t, t, side="right"), 1, len(paths.t) - 1)
    share = (t - paths.t[after - 1]) / (paths.t[after] - paths.t[after - 1])
    return values[:, after - 1] + share[:, None] * (values[:, after] - values[:, after - 1])


def quantiles(paths: Poses, levels: Sequence[float] = LEVELS) -> Array:
    """Compute quantiles over the draws of x, y and yaw at every time.

    Args:
        paths: The draws.
        levels: Levels of the quantiles, from 0 to 1 [-].

    Returns:
        Quantiles, shape (levels, n, 3) [m, m, rad].
    """
    return np.quantile(paths.states, np.asarray(levels), axis=0)


def mean_path(paths: Poses) -> Poses:
    """Return the mean position and heading at every time."""
    return Poses(paths.t, paths.position.mean(axis=0), paths.yaw.mean(axis=0))


def _from_zero(steps: Array) -> Array:
    """Return the cumulative sum of steps along axis 1, starting at zero."""
    return np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)
