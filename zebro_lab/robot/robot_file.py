# SPDX-License-Identifier: MIT
"""`robot.toml`: the robot that walks, what its leg log's signs mean, and the marker it carries."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from model.errors import DomainError
from model.robot import N_LEGS, Robot
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.known_keys import require_known
from zebro_lab.files.toml_table import quoted
from zebro_lab.files.units import quantity_to_si
from zebro_lab.robot.marker_print import KIT_PRINT, MarkerPrint

ROBOT_FILE = "robot.toml"
_TOP = ("mass", "body_size", "inertia", "legs", "hips", "marker")
_LEGS = ("radius", "arc_deg", "offset_deg", "sign")
_MARKER = ("dictionary", "id", "side", "position", "roll_pitch_yaw_deg", "height")
_FORWARD = (1,) * N_LEGS


@dataclass(frozen=True)
class Marker:
    """Where a marker sits on the robot.

    Attributes:
        position: Its centre in the body frame, shape (3,) [m].
        roll_pitch_yaw: Its orientation in the body frame, R = Rz Ry Rx, shape (3,) [rad].
        height: Height of its centre above the ground while the robot stands; None where nobody
            measured it [m].
        printed: What is printed on it; the kit's where the file does not say.
    """

    position: tuple[float, float, float]
    roll_pitch_yaw: tuple[float, float, float] = (0.0, 0.0, 0.0)
    height: float | None = None
    printed: MarkerPrint = KIT_PRINT


@dataclass(frozen=True)
class RobotFile:
    """What a `robot.toml` says.

    Attributes:
        robot: The robot.
        leg_sign: For each leg 1 where its reported angle grows as it walks forward, else -1,
            shape (6,).
        marker: Its marker; None where it has none.
        file: The file; None for the source's robot.
    """

    robot: Robot = field(default_factory=Robot)
    leg_sign: tuple[int, ...] = _FORWARD
    marker: Marker | None = None
    file: Path | None = None


def read_robot_file(file: Path) -> RobotFile:
    """Read and check a `robot.toml`; what it leaves out is the source's robot's.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is no TOML, or holds an unknown key, an impossible value or a wrong unit.
    """
    advice = f"expected a {ROBOT_FILE} (walk --write-robot {file} starts one)"
    return _Reader(file).robot_file(read_toml_document(file, advice=advice))


def render_robot_file(described: RobotFile) -> str:
    """Write a robot as commented TOML that `read_robot_file` reads back.

    >>> print(render_robot_file(RobotFile()).splitlines()[3])
    mass = 2.17  # [kg]
    """
    robot = described.robot
    hips = "".join(
        f"{leg} = {_listed(hip)}\n" for leg, hip in enumerate(robot.hips.tolist(), start=1)
    )
    return _TEMPLATE.format(
        mass=_number(robot.mass),
        body_size=_listed(robot.body_size),
        inertia=_inertia_line(robot),
        radius=_number(robot.leg_radius),
        arc_deg=_number(np.degrees(robot.leg_arc)),
        offset_deg=_listed(np.degrees(robot.leg_offset)),
        sign=list(described.leg_sign),
        hips=hips,
        marker=_marker_section(described.marker),
    )


_TEMPLATE = """\
# The robot. SI units; a text such as "35 mm" carries its own; *_deg is in degrees.
# Frames, legs and signs: docs/conventions.md.

mass = {mass}  # [kg]
body_size = {body_size}  # length, width, height [m]
{inertia}  # about x, y, z [kg m2]; a uniform cuboid's when left out

[legs]
radius = {radius}  # of the arc [m]
arc_deg = {arc_deg}  # 180 is a half circle; real legs have about 200
offset_deg = {offset_deg}  # of legs 1 to 6: true angle minus the one reported
sign = {sign}  # -1 where a leg's reported angle falls as it walks forward

[hips]  # x forward, y left, z up from the body's centre [m], by leg
{hips}
{marker}"""


def _inertia_line(robot: Robot) -> str:
    if robot.inertia is None:
        return f"# inertia = {_listed(robot.principal_inertia.round(6))}"
    return f"inertia = {_listed(robot.inertia)}"


def _marker_section(marker: Marker | None) -> str:
    shown = marker or Marker((0.0, 0.0, 0.0385))
    angles = _listed(np.degrees(shown.roll_pitch_yaw))
    height = "0.1" if shown.height is None else _number(shown.height)
    lines = [
        "[marker]",
        f"dictionary = {quoted(shown.printed.dictionary)}",
        f"id = {shown.printed.number}  # its number in the dictionary",
        f"side = {_number(shown.printed.side)}  # of the black square [m]",
        f"position = {_listed(shown.position)}  # of its centre in the body frame [m]",
        f"roll_pitch_yaw_deg = {angles}",
        f"height = {height}  # of its centre above the ground while the robot stands [m]",
    ]
    if marker is None:
        lines = [f"# {line}" for line in lines]
    elif marker.height is None:
        lines[-1] = f"# {lines[-1]}"
    return "\n".join(lines) + "\n"


def _listed(numbers: Any) -> str:
    return f"[{', '.join(_number(number) for number in numbers)}]"


def _number(value: float) -> str:
    return repr(float(f"{float(value):.12g}"))  # degrees come back without the last bits' noise


@dataclass(frozen=True)
class _Reader:
    """Turns the tables of one document into values, naming the file in every error."""

    file: Path

    def robot_file(self, document: Mapping[str, Any]) -> RobotFile:
        require_known(document, _TOP, file=self.file, where="")
        legs, hips = self._table(document, "legs"), self._table(document, "hips")
        require_known(legs, _LEGS, file=self.file, where="legs.")
        require_known(hips, [str(leg) for leg in range(1, N_LEGS + 1)], file=self.file,
                      where="hips.")  # fmt: skip
        return RobotFile(
            robot=self._robot(document, legs, hips),
            leg_sign=self._signs(legs.get("sign", _FORWARD)),
            marker=self._marker(document),
            file=self.file,
        )

    def _robot(
        self, document: Mapping[str, Any], legs: Mapping[str, Any], hips: Mapping[str, Any]
    ) -> Robot:
        given: dict[str, Any] = {}
        if "mass" in document:
            given["mass"] = self._quantity("mass", document["mass"], "kg")
        if "body_size" in document:
            given["body_size"] = self._row("body_size", document["body_size"], 3, "m")
        if "inertia" in document:
            given["inertia"] = self._row("inertia", document["inertia"], 3, "kg m^2")
        if "radius" in legs:
            given["leg_radius"] = self._quantity("legs.radius", legs["radius"], "m")
        if "arc_deg" in legs:
            given["leg_arc"] = np.radians(self._plain("legs.arc_deg", legs["arc_deg"]))
        if "offset_deg" in legs:
            offsets = self._degrees("legs.offset_deg", legs["offset_deg"], N_LEGS)
            given["leg_offset"] = np.array(offsets)
        if hips:
            given["hips"] = self._hips(hips)
        try:
            return Robot(**given)
        except DomainError as error:
            raise SettingsError(str(error), file=self.file) from error

    def _hips(self, hips: Mapping[str, Any]) -> np.ndarray:
        places = Robot().hips.copy()
        for leg, place in hips.items():
            places[int(leg) - 1] = self._row(f"hips.{leg}", place, 3, "m")
        return places

    def _signs(self, found: Any) -> tuple[int, ...]:
        signs = tuple(self._list("legs.sign", found, N_LEGS))
        if any(sign not in (1, -1) or isinstance(sign, bool) for sign in signs):
            raise self._error("legs.sign", f"{list(signs)} has an entry that is neither 1 nor -1")
        return signs

    def _marker(self, document: Mapping[str, Any]) -> Marker | None:
        if "marker" not in document:
            return None
        marker = self._table(document, "marker")
        require_known(marker, _MARKER, file=self.file, where="marker.")
        if "position" not in marker:
            raise self._error(
                "marker.position", "missing; give its centre in the body frame as [x, y, z] in m"
            )
        x, y, z = self._row("marker.position", marker["position"], 3, "m")
        printed = self._printed(marker)
        angles = marker.get("roll_pitch_yaw_deg", (0.0, 0.0, 0.0))
        roll, pitch, yaw = self._degrees("marker.roll_pitch_yaw_deg", angles, 3)
        height = marker.get("height")
        if height is not None and (height := self._quantity("marker.height", height, "m")) <= 0:
            raise self._error(
                "marker.height", f"{height:g} m is not above the ground; expected > 0"
            )
        return Marker((x, y, z), (roll, pitch, yaw), height, printed)

    def _printed(self, marker: Mapping[str, Any]) -> MarkerPrint:
        dictionary = marker.get("dictionary", KIT_PRINT.dictionary)
        if not isinstance(dictionary, str) or not dictionary:
            raise self._error("marker.dictionary", f"expected a name, found {dictionary!r}")
        number = marker.get("id", KIT_PRINT.number)
        if isinstance(number, bool) or not isinstance(number, int) or number < 0:
            raise self._error("marker.id", f"expected a whole number from 0 on, found {number!r}")
        side = self._quantity("marker.side", marker.get("side", KIT_PRINT.side), "m")
        if side <= 0:
            raise self._error("marker.side", f"is {side:g} m; expected more than 0")
        return MarkerPrint(dictionary, number, side)

    def _table(self, document: Mapping[str, Any], name: str) -> Mapping[str, Any]:
        table = document.get(name, {})
        if not isinstance(table, dict):
            raise self._error(name, f"expected a table, found {table!r}")
        return table

    def _list(self, key: str, found: Any, length: int) -> Sequence[Any]:
        if not isinstance(found, (list, tuple)) or len(found) != length:
            raise self._error(key, f"expected a list of {length}, found {found!r}")
        return found

    def _row(self, key: str, found: Any, length: int, unit: str) -> tuple[Any, ...]:
        numbers = self._list(key, found, length)
        return tuple(
            self._quantity(f"{key}[{i}]", number, unit) for i, number in enumerate(numbers)
        )

    def _degrees(self, key: str, found: Any, length: int) -> tuple[float, ...]:
        numbers = self._list(key, found, length)
        plain = [self._plain(f"{key}[{i}]", number) for i, number in enumerate(numbers)]
        return tuple(np.radians(plain).tolist())

    def _plain(self, key: str, found: Any) -> float:
        if isinstance(found, bool) or not isinstance(found, (int, float)) or not np.isfinite(found):
            raise self._error(key, f"expected a number of degrees, found {found!r}")
        return float(found)

    def _quantity(self, key: str, found: Any, unit: str) -> float:
        if isinstance(found, bool) or not isinstance(found, (int, float, str)):
            raise self._error(key, f"expected a number in {unit} or a text such as '1 {unit}'")
        try:
            return quantity_to_si(found, unit)
        except UnitError as error:
            raise self._error(key, str(error)) from error

    def _error(self, key: str, problem: str) -> SettingsError:
        return SettingsError(problem, file=self.file, key=key)
