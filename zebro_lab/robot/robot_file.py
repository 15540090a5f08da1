# SPDX-License-Identifier: MIT
"""Read and write `robot.toml`: robot parameters, signs of the leg angles, and the robot marker."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from model.errors import DomainError
from model.robot import N_LEGS, Robot
from zebro_lab.files.settings_table import SettingsTable, fill_in, read_settings
from zebro_lab.robot.marker_print import KIT_PRINT, MarkerPrint

ROBOT_FILE = "robot.toml"
_MOST_NUMBER = 999_999  # of a marker; its dictionary has far fewer
LARGEST, HEAVIEST = 3.0, 100.0
"""Largest length [m] and mass [kg] that a number without a unit can give a walking robot."""
_SLOWEST_DEG = 6.0  # a second
_FORWARD = (1,) * N_LEGS


@dataclass(frozen=True)
class Marker:
    """Pose of the marker on the robot, and its printed pattern.

    Attributes:
        position: Centre of the marker in the body frame, shape (3,) [m].
        roll_pitch_yaw: Orientation of the marker in the body frame, R = Rz Ry Rx, shape (3,) [rad].
        height: Height of the marker's centre above the ground while the robot stands [m]; None if
            it was not measured.
        printed: Dictionary, number and size of the printed marker; that of the kit by default.
        side_sd: Standard deviation of the side of the print [m].
        position_sd: Standard deviation of x and of y of `position` [m].
        yaw_sd: Standard deviation of the yaw of `roll_pitch_yaw` [rad].
    """

    position: tuple[float, float, float]
    roll_pitch_yaw: tuple[float, float, float] = (0.0, 0.0, 0.0)
    height: float | None = None
    printed: MarkerPrint = KIT_PRINT
    side_sd: float = 2e-4
    position_sd: float = 5e-4
    yaw_sd: float = 3e-3


@dataclass(frozen=True)
class RobotFile:
    """Content of a `robot.toml`.

    Attributes:
        robot: Mass, body and leg parameters of the robot.
        leg_sign: For each leg 1 if its reported angle grows as the robot walks forward, else -1,
            shape (6,).
        marker: The robot marker; None if the file has no section for it.
        file: The `robot.toml`; None for the thesis's robot.
        leg_speed_limit: Largest speed of a leg [rad/s]; None if it is not known.
    """

    robot: Robot = field(default_factory=Robot)
    leg_sign: tuple[int, ...] = _FORWARD
    marker: Marker | None = None
    file: Path | None = None
    leg_speed_limit: float | None = None


def read_robot_file(file: Path) -> RobotFile:
    """Read and check a `robot.toml`; missing values are those of the thesis's robot.

    A marker needs its position; its other values are by default those of the printed kit.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file is not TOML, has an unknown key, an invalid value or unit, an
            improbable length or mass without a unit, or a marker without position, or no robot can
            have these values.
    """
    advice = f"zebro-lab init {file} --kind robot writes a {ROBOT_FILE} to edit"
    top = read_settings(file, advice=advice)
    legs = top.table("legs")
    described = RobotFile(
        robot=_robot(top, legs),
        leg_sign=legs.signs("sign", N_LEGS) if "sign" in legs else _FORWARD,
        marker=_marker(top.table("marker")) if "marker" in top else None,
        file=file,
        leg_speed_limit=_speed_limit(legs),
    )
    top.finish()
    return described


def render_robot_file(described: RobotFile) -> str:
    """Serialise a robot as commented TOML that `read_robot_file` reads.

    Default inertia, an unknown limit of leg speed, a missing marker and an unmeasured marker height
    are commented out.

    >>> print(render_robot_file(RobotFile()).splitlines()[3])
    mass = 2.17  # [kg]
    """
    robot = described.robot
    inertia = robot.principal_inertia.round(6) if robot.inertia is None else robot.inertia
    text = fill_in(_TEMPLATE, {
        "mass": robot.mass,
        "body_size": robot.body_size,
        "inertia": inertia,
        "legs": {
            "radius": robot.leg_radius,
            "arc_deg": np.degrees(robot.leg_arc),
            "offset_deg": np.degrees(robot.leg_offset),
            "sign": described.leg_sign,
            "speed_limit_deg_per_s": np.degrees(described.leg_speed_limit or np.radians(400)),
        },
        "hips": {str(leg): hip for leg, hip in enumerate(robot.hips, start=1)},
    })  # fmt: skip
    if robot.inertia is None:
        text = text.replace("\ninertia", "\n# inertia", 1)
    if described.leg_speed_limit is None:
        text = text.replace("\nspeed_limit", "\n# speed_limit", 1)
    return f"{text}\n{_marker_section(described.marker)}"


_TEMPLATE = """\
# The robot, in SI units or as texts with a unit such as "35 mm"; *_deg is in degrees.
# Frames, legs and signs: docs/conventions.md.

mass = 0  # [kg]
body_size = []  # length, width, height [m]
inertia = []  # about x, y, z [kg m2]; default: inertia of a uniform cuboid

[legs]
radius = 0  # radius of the leg's arc [m]
arc_deg = 0  # angle of the leg's arc: 180 is a half circle; real legs have about 200
offset_deg = []  # of legs 1 to 6: true angle minus reported angle
sign = []  # of legs 1 to 6: -1 if the reported angle falls while the robot walks forward
speed_limit_deg_per_s = 0  # largest speed of a leg; walk warns of gaits with faster legs

[hips]  # position of each hip from the body's centre: x forward, y left, z up [m]
"""
_MARKER_TEMPLATE = """\
[marker]
dictionary = ""
id = 0  # number of the marker in the dictionary
side = 0  # side of the black square [m]
side_sd = 0  # standard deviation of what was measured: 0.2 mm by a ruler, 0.05 mm by callipers
position = []  # centre of the marker in the body frame [m]
position_sd = 0
roll_pitch_yaw_deg = []
yaw_sd_deg = 0
height = 0.1  # height of the marker's centre above the ground while the robot stands [m]
"""


def _marker_section(marker: Marker | None) -> str:
    """Format the section of the marker, in comments if there is none."""
    shown = marker or Marker((0.0, 0.0, 0.0385))
    measured = {} if shown.height is None else {"height": shown.height}
    text = fill_in(_MARKER_TEMPLATE, {"marker": {
        "dictionary": shown.printed.dictionary,
        "id": shown.printed.number,
        "side": shown.printed.side,
        "side_sd": shown.side_sd,
        "position": shown.position,
        "position_sd": shown.position_sd,
        "roll_pitch_yaw_deg": np.degrees(shown.roll_pitch_yaw),
        "yaw_sd_deg": np.degrees(shown.yaw_sd),
        **measured,
    }})  # fmt: skip
    if marker is None:
        return "".join(f"# {line}" for line in text.splitlines(keepends=True))
    return text if measured else text.replace("\nheight", "\n# height", 1)


def _robot(top: SettingsTable, legs: SettingsTable) -> Robot:
    """Construct the robot from the given keys; missing keys are those of the thesis's robot.

    Raises `SettingsError` for values that no robot can have.
    """
    given: dict[str, Any] = {}
    if "mass" in top:
        given["mass"] = top.quantity("mass", "kg", usual=HEAVIEST)
    if "body_size" in top:
        given["body_size"] = top.quantities("body_size", 3, "m", usual=LARGEST)
    if "inertia" in top:
        given["inertia"] = top.quantities("inertia", 3, "kg m^2")
    if "radius" in legs:
        given["leg_radius"] = legs.quantity("radius", "m", usual=LARGEST)
    if "arc_deg" in legs:
        given["leg_arc"] = np.radians(legs.number("arc_deg"))
    if "offset_deg" in legs:
        given["leg_offset"] = np.radians(legs.numbers("offset_deg", N_LEGS))
    hips = top.table("hips")
    if not hips.empty:
        given["hips"] = _hips(hips)
    try:
        return Robot(**given)
    except DomainError as error:
        raise top.fault(str(error)) from error


def _speed_limit(legs: SettingsTable) -> float | None:
    """Return the largest speed of a leg [rad/s]; None if none is given.

    Raises `SettingsError` for less than `_SLOWEST_DEG`, which is probably in another unit.
    """
    key = "speed_limit_deg_per_s"
    if key not in legs:
        return None
    limit = legs.number(key)
    if limit < _SLOWEST_DEG:
        raise legs.fault(
            f"is {limit:g} deg/s; expected {_SLOWEST_DEG:g} or more: a leg that turns slower than "
            "once a minute walks nowhere; is it in turns or radians a second?", key,
        )  # fmt: skip
    return float(np.radians(limit))


def _hips(hips: SettingsTable) -> np.ndarray:
    """Return the position of each hip, shape (6, 3) [m]; those not given are the thesis's.

    Raises `SettingsError` for a hip that is not a position or on the wrong side of the body.
    """
    places = Robot().hips.copy()
    for leg in range(1, N_LEGS + 1):
        if str(leg) in hips:
            places[leg - 1] = hips.quantities(str(leg), 3, "m", usual=LARGEST)
            _require_side(hips, leg, places[leg - 1])
    return places


def _require_side(hips: SettingsTable, leg: int, place: np.ndarray) -> None:
    """Raise `SettingsError` for an odd leg on the right of the body, or an even one on the left."""
    side, sign = ("left", 1) if leg % 2 else ("right", -1)
    if sign * place[1] < 0:
        raise hips.fault(
            f"y is {place[1]:g} m; expected {'more' if leg % 2 else 'less'} than 0, as leg {leg} "
            f"is on the {side} and y grows to the left (docs/conventions.md): are the legs "
            "numbered otherwise, or is y meant to the right?",
            str(leg),
        )


def _marker(marker: SettingsTable) -> Marker:
    """Read the section of the marker; `SettingsError` without `position`, the one required key."""
    if "position" not in marker:
        raise marker.fault(
            "is missing; give the marker's centre in the body frame as [x, y, z] in m", "position"
        )
    x, y, z = marker.quantities("position", 3, "m", usual=LARGEST)
    roll, pitch, yaw = np.radians(
        marker.numbers("roll_pitch_yaw_deg", 3) if "roll_pitch_yaw_deg" in marker else np.zeros(3)
    ).tolist()
    height = None
    if "height" in marker:
        height = marker.quantity("height", "m", above=0.0, usual=LARGEST)
    printed = MarkerPrint(
        marker.text("dictionary", KIT_PRINT.dictionary, least=1),
        marker.whole("id", KIT_PRINT.number, most=_MOST_NUMBER),
        marker.quantity("side", "m", default=KIT_PRINT.side, above=0.0, usual=LARGEST),
    )
    return Marker(
        (x, y, z), (roll, pitch, yaw), height, printed,
        marker.quantity("side_sd", "m", default=Marker.side_sd, least=0.0, usual=LARGEST),
        marker.quantity("position_sd", "m", default=Marker.position_sd, least=0.0, usual=LARGEST),
        float(np.radians(marker.quantity("yaw_sd_deg", "dimensionless",
                                         default=float(np.degrees(Marker.yaw_sd)), least=0.0))),
    )  # fmt: skip
