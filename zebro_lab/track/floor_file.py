# SPDX-License-Identifier: MIT
"""Read and format `floor.toml`: markers and points on the floor, as measured with a tape."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from tracking.errors import TrackingError
from tracking.floor import FloorMap, FloorMarker, FloorPoint
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.settings_table import SettingsTable, fill_in, inline_table, read_settings
from zebro_lab.robot.marker_numbers import require_in_dictionary
from zebro_lab.robot.marker_print import KIT_PRINT

FLOOR_FILE = "floor.toml"
DICTIONARY = KIT_PRINT.dictionary
"""Dictionary of the markers that the kit prints."""

_COMMON = {"side": "m", "position_sd": "m", "yaw_sd_deg": "dimensionless", "side_sd": "m"}
_MOST_DIGITS = 6  # of the number of a marker
_POSITION_SD, _YAW_SD_DEG, _SIDE_SD = 1e-3, float(np.degrees(0.01)), 2e-4


def read_floor_file(file: Path) -> FloorMap:
    """Read and validate a `floor.toml`.

    Raises:
        NotFound: The file does not exist.
        SettingsError: The file is not TOML, has no marker and no point, or holds an unknown key or
            an impossible value. Fewer than four points without a marker, from which no camera's
            pose can be computed, raise only when a photograph is located.
    """
    table = read_settings(file, advice="`zebro-lab camera kit` starts one")
    if "focal" in table:
        raise table.fault("has a focal length as a camera.toml does; expected a floor.toml: are "
                          "--camera and --floor exchanged?")  # fmt: skip
    markers, points = table.table("markers"), table.table("points")
    if markers.empty and points.empty:
        raise table.fault("no marker and no point; expected a marker, or four points", "markers")
    common = _common(table)
    try:
        dictionary = table.text("dictionary", DICTIONARY, least=1)
        floor = FloorMap(
            dictionary,
            tuple(_marker(markers, number, common) for number in markers.unread),
            tuple(_point(points, name, common) for name in points.unread),
        )
        require_in_dictionary(dictionary, floor.marker_ids)
    except TrackingError as error:
        raise SettingsError(str(error), file=file) from error
    table.finish()
    return floor


def _common(table: SettingsTable) -> dict[str, float]:
    """Read the defaults of marks: standard deviations [m, deg] and, if given, the side [m]."""
    stated = {
        key: table.quantity(key, unit, above=0.0) for key, unit in _COMMON.items() if key in table
    }
    return {"position_sd": _POSITION_SD, "yaw_sd_deg": _YAW_SD_DEG, "side_sd": _SIDE_SD} | stated


def _marker(markers: SettingsTable, number: str, common: Mapping[str, float]) -> FloorMarker:
    """Read the marker with this number; what its table leaves out comes from `common`.

    The side must be given in one of the two. Angles are in degrees in the file.

    Raises:
        SettingsError: `number` is not one of up to `_MOST_DIGITS` digits, or a value is missing or
            invalid.
    """
    if not number.isdecimal() or len(number) > _MOST_DIGITS:
        raise markers.fault("is not a marker's number; expected up to 6 digits, as in 10", number)
    table = markers.table(number)
    own = {
        key: table.quantity(key, unit, default=common.get(key), above=0.0)
        for key, unit in _COMMON.items()
    }
    return FloorMarker(
        int(number),
        own["side"],
        table.quantity("x", "m"),
        table.quantity("y", "m"),
        yaw=float(np.radians(table.quantity("yaw_deg", "dimensionless", default=0.0))),
        z=table.quantity("z", "m", default=0.0),
        position_sd=own["position_sd"],
        yaw_sd=float(np.radians(own["yaw_sd_deg"])),
        side_sd=own["side_sd"],
    )


def _point(points: SettingsTable, name: str, common: Mapping[str, float]) -> FloorPoint:
    """Read the point of this name; `common` gives the standard deviation that it lacks."""
    table = points.table(name)
    return FloorPoint(
        name,
        table.quantity("x", "m"),
        table.quantity("y", "m"),
        z=table.quantity("z", "m", default=0.0),
        position_sd=table.quantity("position_sd", "m", default=common["position_sd"], above=0.0),
    )


def render_floor_file(floor: FloorMap, *, heading: str) -> str:
    """Format a floor as commented TOML, which `read_floor_file` reads.

    Args:
        floor: Markers and points of the floor.
        heading: Text of the first comment lines, without their `#`.
    """
    lines = [*(f"# {line}".rstrip() for line in heading.splitlines()), *_LEGEND]
    template = "\n".join([*lines, "", 'dictionary = ""', "", "[markers]", ""])
    values = {
        "dictionary": floor.dictionary,
        "markers": {str(each.marker_id): _marker_line(each) for each in floor.markers},
    }
    if floor.points:
        template += "\n[points]\n"
        values["points"] = {each.name: _point_line(each) for each in floor.points}
    return fill_in(template, values)


_LEGEND = (
    "# x, y: centre of the marker [m]; y grows to the left of x, seen from above.",
    "# yaw_deg: turn of the print's reading direction from x, counter-clockwise.",
    "# side: of the black square [m]; z: height of the print [m].",
    "# *_sd: standard deviation of what the tape says. A text such as \"35 mm\" carries its unit.",
)  # fmt: skip


def _marker_line(marker: FloorMarker) -> Mapping[str, float]:
    """Return a marker's keys as an inline TOML table, angles in degrees."""
    return _line(
        x=marker.x, y=marker.y, yaw_deg=np.degrees(marker.yaw), z=marker.z, side=marker.side,
        position_sd=marker.position_sd, yaw_sd_deg=np.degrees(marker.yaw_sd),
        side_sd=marker.side_sd,
    )  # fmt: skip


def _point_line(point: FloorPoint) -> Mapping[str, float]:
    """Return a point's keys as an inline TOML table."""
    return _line(x=point.x, y=point.y, z=point.z, position_sd=point.position_sd)


def _line(**values: float) -> Mapping[str, float]:
    """Return an inline TOML table of values, rounded to 7 decimals."""
    return inline_table({key: round(float(value), 7) for key, value in values.items()})
