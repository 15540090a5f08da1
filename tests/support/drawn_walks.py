# SPDX-License-Identifier: MIT
"""Draw a walk before a camera: true values, what a lab would be told of them, pixels of corners.

SIMULATED. Nothing here is of the tracker: the pinhole camera with Brown's distortion, the rotations
and the corners are written out again, with numpy alone, so that an error of the one is not an error
of the other too. Every value that is told is the true one plus an error of the standard deviation
that is told with it.
"""

from dataclasses import dataclass, field

import numpy as np

from model.arrays import Array

SQUARE = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]])
"""Corners of a print of side 1: top left, top right, bottom right, bottom left; right and up."""

INTERVAL = 2.0
"""Time between photographs [s]."""
LENGTH = 1.3
"""Length of a walk, times its scale [m]."""
WOBBLE = (1e-3, 1e-3, 2e-3)
"""Standard deviation of the gait's sway at each photograph, x, y [m] and yaw [rad]."""


@dataclass(frozen=True)
class Lens:
    """A lens: `focal` fx, fy and `centre` cx, cy [px], `distortion` k1, k2, p1, p2, k3 [-].

    `sd` are the standard deviations of these nine as a calibration tells them.
    """

    focal: tuple[float, float]
    centre: tuple[float, float]
    distortion: tuple[float, float, float, float, float]
    sd: tuple[float, ...]

    @property
    def values(self) -> Array:
        """All nine numbers in the order of `sd`."""
        return np.array([*self.focal, *self.centre, *self.distortion])


PLAIN = Lens(
    (1394.0, 1394.0),
    (639.5, 479.5),
    (0.0, 0.0, 0.0, 0.0, 0.0),
    (2.0, 2.0, 2.0, 2.0, 4e-3, 0, 0, 0, 0),
)
WIDE = Lens((980.0, 982.0), (650.0, 470.0), (-0.12, 0.03, 5e-4, -4e-4, 0.0),
            (1.5, 1.5, 1.5, 1.5, 3e-3, 3e-3, 2e-4, 2e-4, 0))  # fmt: skip


@dataclass(frozen=True)
class Spreads:
    """Standard deviations that the lab is told, and those of the photographs themselves.

    Attributes:
        tape: x and y of a floor mark [m].
        mark_turn: Its yaw [rad].
        mark_side: Its side [m].
        side: Side of the robot's marker [m].
        place: x and y of the robot's marker on the body [m].
        turn: Its yaw on the body [rad].
        height: Mean height of the body over the walk [m].
        bounce: Height of the body about its mean [m].
        tilt: Mean roll and pitch, and roll and pitch about their means [rad].
        edges: How far edges lie outwards: of all markers alike, and of each one besides [px].
        corner: Noise of a coordinate of a corner of a marker 50 px wide [px].
    """

    tape: float = 1e-3
    mark_turn: float = 0.01
    mark_side: float = 2e-4
    side: float = 2e-4
    place: float = 5e-4
    turn: float = 3e-3
    height: float = 5e-3
    bounce: float = 5e-3
    tilt: float = 0.02
    edges: float = 0.03
    corner: float = 0.006


@dataclass(frozen=True)
class Sight:
    """A marker in a photograph: corners (4, 2) [px] and the covariance that is told of them."""

    corners: Array
    covariance: Array


@dataclass(frozen=True)
class Told:
    """What the lab writes down.

    Attributes:
        lens: fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-], shape (9,).
        marks: By number of the floor's marker, x, y [m], yaw [rad] and side [m].
        robot: Side of the robot's marker, x and y of its place on the body [m], its turn [rad].
        height: Height of the body [m].
    """

    lens: Array
    marks: dict[int, Array]
    robot: Array
    height: float


@dataclass(frozen=True)
class Course:
    """An arc walked with wandering speed and curvature, through the middle of the floor.

    Attributes:
        heading: At its start [rad].
        turn: By how much it turns in all, but for the wandering [rad].
        speed_period: Period of the wandering speed, by a tenth [s].
        speed_phase: Its phase at the start [rad].
        turn_period: Period of the wandering curvature, by 0.3 [s].
    """

    heading: float
    turn: float
    speed_period: float
    speed_phase: float
    turn_period: float

    def poses(self, t: Array, scale: float) -> Array:
        """Compute x, y [m] and yaw [rad] at times that are `INTERVAL` apart, shape (n, 3)."""
        fine = np.linspace(0, t[-1], 50 * len(t))
        wave = np.sin(2 * np.pi * fine / self.speed_period + self.speed_phase)
        speed = LENGTH * scale / t[-1] * (1 + 0.1 * wave)
        turn = self.turn / t[-1] * (1 + 0.3 * np.sin(2 * np.pi * fine / self.turn_period))
        step = fine[1] - fine[0]
        yaw = self.heading + np.cumsum(turn) * step
        xy = np.cumsum(speed * step * np.stack((np.cos(yaw), np.sin(yaw))), axis=1).T
        xy -= xy.mean(axis=0)
        rows = np.searchsorted(fine, t - 1e-9)
        return np.column_stack((xy, yaw))[rows]


@dataclass(frozen=True)
class DrawnWalk:
    """A walk as drawn.

    Attributes:
        lens: The lens, with the standard deviations of its calibration.
        spreads: All other standard deviations.
        told: The values as told.
        t: Times of the photographs, shape (n,) [s].
        poses: True x, y [m] and yaw [rad] of the body, shape (n, 3).
        robot: The robot's marker in each photograph.
        floor: By photograph and number, the floor's markers.
        bodies: x, y, z [m], roll, pitch and yaw [rad] of the body, shape (n, 6).
        camera: Rotation of the camera, world to camera, shape (3, 3), and its place, (3,) [m].
    """

    lens: Lens
    spreads: Spreads
    told: Told
    t: Array
    poses: Array
    robot: list[Sight]
    floor: list[dict[int, Sight]]
    bodies: Array
    camera: tuple[Array, Array]
    size: tuple[int, int] = field(default=(1280, 960))


def draw_walk(
    rng: np.random.Generator, *, lens: Lens, distance: float, spreads: Spreads, photos: int = 15
) -> DrawnWalk:
    """Draw one walk with all its errors.

    Args:
        rng: Source of randomness.
        lens: The true lens, with the standard deviations of its calibration.
        distance: Distance of the camera from the middle of the floor [m].
        spreads: All other standard deviations.
        photos: Number of photographs, one every 2 s.
    """
    s = spreads
    scale = distance / 3.4 * 1394.0 / lens.focal[0]  # the floor fills the picture
    R, eye = _camera(rng, distance)
    told_lens = lens.values + rng.normal(0, 1, 9) * lens.sd
    marks, told_marks = {}, {}
    for number, (x, y) in enumerate([(-0.9, -0.9), (0.95, -0.85), (1.1, 0.9), (-1.0, 1.0)], 10):
        true = np.array([scale * x, scale * y, rng.uniform(-3, 3), 0.1])
        marks[number] = true
        told_marks[number] = true + rng.normal(0, 1, 4) * [s.tape, s.tape, s.mark_turn, s.mark_side]
    robot = np.array([0.12, 0.0, 0.0, 0.0])
    told_robot = robot + rng.normal(0, 1, 4) * [s.side, s.place, s.place, s.turn]
    height = 0.0615
    t = np.arange(photos, dtype=np.float64) * INTERVAL
    course = _course(rng)
    poses = course.poses(t, scale) + rng.normal(0, 1, (photos, 3)) * WOBBLE
    body = np.zeros((photos, 6))
    body[:, [0, 1, 5]] = poses
    body[:, 2] = height + rng.normal(0, s.height) + rng.normal(0, s.bounce, photos)
    body[:, 3:5] = rng.normal(0, s.tilt, 2) + rng.normal(0, s.tilt, (photos, 2))
    edges = rng.normal(0, s.edges)
    own_edges = {number: rng.normal(0, s.edges) for number in marks}
    seen = {number: _drawn(rng, lens, R, eye, on_floor(mark), s, edges + own_edges[number])
            for number, mark in marks.items()}  # fmt: skip
    return DrawnWalk(
        lens, s, Told(told_lens, told_marks, told_robot, height), t, poses,
        [_drawn(rng, lens, R, eye, on_body(robot, state), s, edges + rng.normal(0, s.edges))
         for state in body],
        [{number: _again(rng, sight) for number, sight in seen.items()} for _ in t], body,
        (R, eye),
    )  # fmt: skip


TOP_HEIGHT = 0.0385
"""Height of the body's flat top, and of the marker on it, over the body's origin [m]."""


def top_in_photo(walk: DrawnWalk, photo: int, places: Array) -> Array:
    """Project places on the body's top.

    Args:
        walk: The walk.
        photo: Number of the photograph, from 0.
        places: x and y in the body frame, shape (n, 2) [m].

    Returns:
        Pixels, shape (n, 2).
    """
    flat = np.column_stack((places, np.full(len(places), TOP_HEIGHT)))
    state = walk.bodies[photo]
    return project(walk.lens.values, *walk.camera, flat @ rotation(state).T + state[:3])


def places_on_top(walk: DrawnWalk, photo: int, pixels: Array) -> Array:
    """Find the places on the body's top that are at given pixels, by Newton's method.

    Args:
        walk: The walk.
        photo: Number of the photograph, from 0.
        pixels: Pixels, shape (n, 2).

    Returns:
        x and y in the body frame, shape (n, 2) [m].
    """
    places, h = np.zeros((len(pixels), 2)), 1e-5
    for _ in range(20):
        missed = pixels - top_in_photo(walk, photo, places)
        slope = np.stack(
            [
                (
                    top_in_photo(walk, photo, places + h * e)
                    - top_in_photo(walk, photo, places - h * e)
                )
                / (2 * h)
                for e in np.eye(2)
            ],
            axis=2,
        )
        places = places + np.linalg.solve(slope, missed[:, :, None])[:, :, 0]
    return places


def _camera(rng: np.random.Generator, distance: float) -> tuple[Array, Array]:
    """Place a camera that looks at the middle of the floor: R, world to camera, and its centre."""
    elevation, around = rng.uniform(0.6, 1.0), rng.uniform(-np.pi, np.pi)
    away = np.array([np.cos(elevation) * np.cos(around), np.cos(elevation) * np.sin(around),
                     np.sin(elevation)])  # fmt: skip
    ahead = -away
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return np.stack((right, np.cross(ahead, right), ahead)), distance * away


def _course(rng: np.random.Generator) -> Course:
    speed_period, speed_phase = rng.uniform(8, 30), rng.uniform(0, 6)
    turn, turn_period = rng.uniform(-1.2, 1.2), rng.uniform(10, 40)
    return Course(rng.uniform(-np.pi, np.pi), turn, speed_period, speed_phase, turn_period)


def on_floor(mark: Array) -> Array:
    """Compute the corners of a mark at x, y, with a yaw and a side, shape (4, 3) [m]."""
    x, y, yaw, side = mark
    c, s = np.cos(yaw), np.sin(yaw)
    across, up = side * SQUARE.T
    return np.column_stack((x + c * across - s * up, y + s * across + c * up, np.zeros(4)))


def on_body(robot: Array, state: Array) -> Array:
    """Compute the corners of the robot's marker in the floor frame, shape (4, 3) [m].

    Args:
        robot: Its side, x and y of its place on the body [m] and its turn [rad].
        state: x, y, z [m], roll, pitch and yaw [rad] of the body.
    """
    side, ahead, left, turn = robot
    across, up = side * SQUARE.T
    c, s = np.cos(turn), np.sin(turn)
    # The print's top points ahead: up is x of the body, across is minus y.
    x, y = ahead + c * up + s * across, left + s * up - c * across
    return np.column_stack((x, y, np.full(4, TOP_HEIGHT))) @ rotation(state).T + state[:3]


def rotation(state: Array) -> Array:
    """Compute the rotation of a body, body to world."""
    roll, pitch, yaw = state[3:]
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    return np.array([
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ])  # fmt: skip


def project(lens: Array, R: Array, eye: Array, points: Array) -> Array:
    """Project points (n, 3) [m] to pixels (n, 2); `lens` as `Lens.values`, R world to camera."""
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = lens
    X, Y, Z = R @ (points - eye).T
    x, y = X / Z, Y / Z
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.column_stack((fx * u + cx, fy * v + cy))


def _drawn(
    rng: np.random.Generator, lens: Lens, R: Array, eye: Array, points: Array, s: Spreads,
    edges: float,
) -> Sight:  # fmt: skip
    """Draw the corners of a marker with edges that lie outwards, and with noise."""
    clean = project(lens.values, R, eye, points)
    side = float(np.linalg.norm(clean[1] - clean[0]))
    sd = s.corner * 50 / side
    covariance = sd**2 * (0.7 * np.eye(8) + 0.3 * np.kron(np.ones((4, 4)), np.eye(2)))
    noise = rng.multivariate_normal(np.zeros(8), covariance).reshape(4, 2)
    return Sight(outwards(clean, edges) + noise, covariance)


def _again(rng: np.random.Generator, sight: Sight) -> Sight:
    """Return a marker at rest in another photograph: what is wrong with it hardly changes."""
    return Sight(sight.corners + rng.normal(0, 1e-3, (4, 2)), sight.covariance)


def outwards(corners: Array, by: float) -> Array:
    """Move the four edges of a quadrilateral outwards and return where they meet."""
    middle = corners.mean(axis=0)
    lines = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        normal = np.array([b[1] - a[1], a[0] - b[0]]) / np.linalg.norm(b - a)
        normal *= np.sign(normal @ (a - middle))
        lines.append((normal, normal @ a + by))
    return np.array([
        np.linalg.solve(np.array([lines[k - 1][0], lines[k][0]]), [lines[k - 1][1], lines[k][1]])
        for k in range(4)
    ])  # fmt: skip
