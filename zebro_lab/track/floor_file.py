# SPDX-License-Identifier: MIT
"""`floor.toml`: markers and points on the floor, as measured with a tape."""

from pathlib import Path

import numpy as np

from tracking.errors import TrackingError
from tracking.floor import FloorMap, FloorMarker, FloorPoint
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.toml_table import TomlTable, quoted, read_toml, spelled
from zebro_lab.robot.marker_numbers import require_in_dictionary
from zebro_lab.robot.marker_print import KIT_PRINT

FLOOR_FILE = "floor.toml"
DICTIONARY = KIT_PRINT.dictionary
"""Dictionary of the markers that the kit prints."""

_TOP = ("dictionary", "side", "position_sd", "yaw_sd_deg", "side_sd", "markers", "points")
_MARKER = ("x", "y", "yaw_deg", "z", "side", "position_sd", "yaw_sd_deg", "side_sd")
_POINT = ("x", "y", "z", "position_sd")
_MOST_DIGITS = 6  # of the number of a marker
_POSITION_SD, _YAW_SD_DEG, _SIDE_SD = 1e-3, float(np.degrees(0.01)), 2e-4


def read_floor_file(file: Path) -> FloorMap:
    """Read and check a `floor.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is no TOML, or holds an unknown key or an impossible value.
    """
    table = read_toml(file, advice="`zebro-lab camera kit` starts one")
    table.require_known(_TOP)
    markers, points = table.table("markers"), table.table("points")
    if not markers.values and not points.values:
        raise table.error("markers", "no marker and no point; the floor needs at least one marker")
    try:
        dictionary = table.text("dictionary", DICTIONARY)
        floor = FloorMap(
            dictionary,
            tuple(_marker(table, markers, number) for number in markers.values),
            tuple(_point(table, points, name) for name in points.values),
        )
        require_in_dictionary(dictionary, floor.marker_ids)
    except TrackingError as error:
        raise SettingsError(str(error), file=file) from error
    return floor


def _marker(top: TomlTable, markers: TomlTable, number: str) -> FloorMarker:
    if not number.isdecimal() or len(number) > _MOST_DIGITS:
        raise markers.error(number, "expected the marker's number in its dictionary as the key")
    table = markers.table(number)
    table.require_known(_MARKER)
    yaw_sd = _own_or_common(top, table, "yaw_sd_deg", "dimensionless", _YAW_SD_DEG)
    return FloorMarker(
        int(number),
        _own_or_common(top, table, "side", "m", None),
        table.number("x", "m"),
        table.number("y", "m"),
        yaw=float(np.radians(table.number("yaw_deg", default=0.0))),
        z=table.number("z", "m", default=0.0),
        position_sd=_own_or_common(top, table, "position_sd", "m", _POSITION_SD),
        yaw_sd=float(np.radians(yaw_sd)),
        side_sd=_own_or_common(top, table, "side_sd", "m", _SIDE_SD),
    )


def _point(top: TomlTable, points: TomlTable, name: str) -> FloorPoint:
    table = points.table(name)
    table.require_known(_POINT)
    return FloorPoint(
        name,
        table.number("x", "m"),
        table.number("y", "m"),
        z=table.number("z", "m", default=0.0),
        position_sd=_own_or_common(top, table, "position_sd", "m", _POSITION_SD),
    )


def _own_or_common(
    top: TomlTable, own: TomlTable, key: str, unit: str, default: float | None
) -> float:
    source = own if key in own or key not in top else top
    return source.number(key, unit, default=default, above=0.0)


def render_floor_file(floor: FloorMap, *, heading: str) -> str:
    """Write a floor as commented TOML that `read_floor_file` reads back.

    Args:
        floor: The floor.
        heading: What it is, as comment lines without their `#`.
    """
    lines = [*(f"# {line}".rstrip() for line in heading.splitlines()), *_LEGEND]
    lines += ["", f'dictionary = "{floor.dictionary}"', "", "[markers]"]
    lines += [f"{marker.marker_id} = {{ {_marker_line(marker)} }}" for marker in floor.markers]
    if floor.points:
        lines += ["", "[points]"]
        lines += [f"{quoted(each.name)} = {{ {_point_line(each)} }}" for each in floor.points]
    return "\n".join(lines) + "\n"


_LEGEND = (
    "# x, y: centre of the marker [m]; y grows to the left of x, seen from above.",
    "# yaw_deg: turn of the print's reading direction from x, counter-clockwise.",
    "# side: of the black square [m]; z: height of the print [m].",
    "# *_sd: standard deviation of what the tape says. A text such as \"35 mm\" carries its unit.",
)  # fmt: skip


def _marker_line(marker: FloorMarker) -> str:
    return ", ".join((
        f"x = {_rounded(marker.x)}", f"y = {_rounded(marker.y)}",
        f"yaw_deg = {_rounded(np.degrees(marker.yaw))}", f"z = {_rounded(marker.z)}",
        f"side = {_rounded(marker.side)}", f"position_sd = {_rounded(marker.position_sd)}",
        f"yaw_sd_deg = {_rounded(np.degrees(marker.yaw_sd))}",
        f"side_sd = {_rounded(marker.side_sd)}",
    ))  # fmt: skip


def _point_line(point: FloorPoint) -> str:
    return ", ".join((
        f"x = {_rounded(point.x)}", f"y = {_rounded(point.y)}", f"z = {_rounded(point.z)}",
        f"position_sd = {_rounded(point.position_sd)}",
    ))  # fmt: skip


def _rounded(value: float) -> str:
    return spelled(round(float(value), 7))
