# SPDX-License-Identifier: MIT
"""Read the ground of a walk (`ground.toml`): slope, steps, roughness, heights, areas of slip."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.counted import counted
from model.errors import DomainError
from model.walk.areas import require_polygon
from model.walk.ground import FLAT, Ground, heights_on, with_slope, with_steps
from model.walk.roughness import CELLS, rough_ground
from model.walk.terrain import SlipArea, Terrain
from zebro_lab.calibration.coulomb_argument import coulomb_numbers
from zebro_lab.calibration.slip_argument import THESIS, NamedSlip, parse_slip
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.settings_table import SettingsTable, read_settings
from zebro_lab.ground.height_map import read_height_picture, read_height_table

_MAP_KEYS: Final = ("step", "origin", "range", "unit")  # step is read before
_FAR, _HIGH = 1000.0, 0.5  # m without a unit: of places, and of steps
_MOST_STEPS, _MOST_AREAS = 100, 100  # a contact is compared with each
MOST_RELIEF: Final = 2.0
"""Largest range of heights of a map whose unit is not given [m]."""


@dataclass(frozen=True)
class GroundFile:
    """A ground as described in a file.

    Attributes:
        terrain: Heights and areas.
        slips: Slip law of each area.
        what: The parts of the ground in words, for the terminal.
        settings: What was read, in SI, JSON-serialisable, for the manifest.
        files: The file, its map of heights, and files of the areas' slip laws.
        notes: Notes, one line each, on the areas' slip laws.
    """

    terrain: Terrain
    slips: tuple[NamedSlip, ...]
    what: tuple[str, ...]
    settings: Mapping[str, object]
    files: tuple[Path, ...]
    notes: tuple[str, ...]


@dataclass
class _Parts:
    """What has been read so far: words, settings and files of the parts."""

    what: list[str] = field(default_factory=list)
    settings: dict[str, object] = field(default_factory=dict)
    files: list[Path] = field(default_factory=list)

    def add(self, key: str, what: str, settings: object) -> None:
        """Add a part under its key of the file."""
        self.what.append(what)
        self.settings[key] = settings


def read_ground(file: Path) -> GroundFile:
    """Read a ground; its parts add up.

    Args:
        file: The `ground.toml`; names of files in it are relative to its folder.

    Raises:
        NotFound: The file, or one that it names, does not exist.
        SettingsError: It is no TOML, a key or value is invalid, keys contradict each other, or it
            describes nothing.
        DataError: A map of heights or a slip law cannot be read.
    """
    table = read_settings(file, advice="expected a ground.toml with slope_deg, [[step]], "
                          "roughness, heights or [[area]]")  # fmt: skip
    parts = _Parts(files=[file])
    # `step` is the distance of the places of heights, or an array of tables.
    step = table.value("step") if "step" in table else None
    ground = _grid(table, step, parts)
    if isinstance(step, list):
        ground = _with_steps(table, step, ground, parts)
    ground = _with_slope(table, ground, parts)
    areas, slips = _areas(table, parts)
    table.finish()
    if not parts.what:
        raise table.fault(
            "describes nothing; expected one or more of slope_deg, [[step]], roughness, heights "
            "and [[area]]"
        )
    for slip in slips:
        parts.files.extend(slip.files)
    notes = tuple(dict.fromkeys(note for slip in slips for note in slip.notes))
    return GroundFile(
        Terrain(ground, areas), slips, tuple(parts.what), parts.settings,
        tuple(dict.fromkeys(parts.files)), notes,
    )  # fmt: skip


def _with_slope(table: SettingsTable, ground: Ground, parts: _Parts) -> Ground:
    if "slope_deg" not in table:
        return ground
    along_x, along_y = table.numbers("slope_deg", 2)
    parts.add("slope_deg", f"slope of {along_x:g} deg along x, {along_y:g} deg along y",
              [along_x, along_y])  # fmt: skip
    try:
        return with_slope(ground, *np.radians([along_x, along_y]).tolist())
    except DomainError as error:
        raise table.fault(str(error), "slope_deg") from error


def _with_steps(table: SettingsTable, found: object, ground: Ground, parts: _Parts) -> Ground:
    steps = []
    for each in _tables(table, "step", found, _MOST_STEPS, "x and height"):
        at = each.quantity("x", "m", usual=_FAR)
        height = each.quantity("height", "m", usual=_HIGH)
        if height == 0:
            raise each.fault("is 0; expected a height above 0, or below it for a step down",
                             "height")  # fmt: skip
        steps.append((at, height))
    named = ", ".join(f"{1000 * height:g} mm at x {at:g} m" for at, height in steps[:3])
    more = f" and {len(steps) - 3} more" if len(steps) > 3 else ""
    parts.add("step", f"{counted(len(steps), 'step')}: {named}{more}",
              [{"x": at, "height": height} for at, height in steps])  # fmt: skip
    edge, rise = np.array(steps).T
    return with_steps(ground, edge, rise)


def _grid(table: SettingsTable, step: object, parts: _Parts) -> Ground:
    """Read the parts that are on a grid: a map of heights, roughness, or their sum."""
    rough = _roughness(table, parts)
    if "heights" not in table:
        for key in _MAP_KEYS:
            if key in table or (key == "step" and step is not None and not isinstance(step, list)):
                raise table.fault(_alone(key), key)
        return FLAT if rough is None else rough
    ground = _heights(table, step, parts)
    if rough is None:
        return ground
    if rough.step * 5 < ground.step:  # ten cells of the roughness are its correlation length
        raise table.fault(
            f"its correlation, {10 * rough.step:g} m, is shorter than two steps of the heights, "
            f"{ground.step:g} m each; expected a longer correlation or a finer map",
            "roughness",
        )
    m, n = ground.height.shape
    x, y = ground.x + ground.step * np.arange(m), ground.y + ground.step * np.arange(n)
    height = ground.height + heights_on(rough, x, y)
    return ground._replace(height=height, highest=float(height.max()))


def _alone(key: str) -> str:
    """Return what is wrong with a key of a map of heights without one."""
    if key == "step":
        return "expected tables [[step]] with x and height, or heights that it is the distance of"
    return "found without heights, which it belongs to"


def _roughness(table: SettingsTable, parts: _Parts) -> Ground | None:
    if "roughness" not in table:
        return None
    rough = table.table("roughness")
    sd = rough.quantity("sd", "m", above=0.0, usual=_HIGH)
    correlation = rough.quantity("correlation", "m", least=0.005, usual=10.0)
    seed = rough.whole("seed", 1, most=2**63)
    parts.add(
        "roughness",
        f"roughness of {1000 * sd:g} mm (sd), correlation length {1000 * correlation:g} mm, seed "
        f"{seed}; repeats every {CELLS * correlation / 10:.3g} m",
        {"sd": sd, "correlation": correlation, "seed": seed},
    )
    try:
        return rough_ground(sd, correlation, rng=np.random.default_rng(seed))
    except DomainError as error:
        raise rough.fault(str(error)) from error


def _heights(table: SettingsTable, step: object, parts: _Parts) -> Ground:
    """Read a map of heights, given by `heights = "FILE"` and keys beside it, or as a table."""
    found = table.value("heights")
    if isinstance(found, str):
        if isinstance(step, list):
            raise table.fault(
                "are tables here, and heights need the distance of their places; write "
                'heights = { file = "…", step = 0.005, origin = [-1.0, -1.0] }', "step",
            )  # fmt: skip
        beside = {key: table.value(key) for key in _MAP_KEYS if key in table}
        given = {} if step is None else {"step": step}
        found = {"file": found, **given, **beside}
    elif step is not None and not isinstance(step, list):
        raise table.fault(_alone("step"), "step")
    spec = table.as_table("heights", found, expected='a file such as "heights.csv"')
    name = spec.text("file", least=1)
    file = Path(table.file).parent / name
    step = spec.quantity("step", "m", above=0.0, usual=0.2)
    x, y = spec.quantities("origin", 2, "m", usual=_FAR)
    rows = _picture(spec, file) if file.suffix.lower() == ".png" else _table(spec, file)
    height = np.ascontiguousarray(rows[::-1].T)
    parts.files.append(file)
    low, high = float(height.min()), float(height.max())
    m, n = height.shape
    parts.add(
        "heights",
        f"heights of {name}, x {x:g} to {x + step * (m - 1):g} m, y {y:g} to "
        f"{y + step * (n - 1):g} m in steps of {step:g} m, {1000 * low:.4g} to "
        f"{1000 * high:.4g} mm",
        {"file": str(file), "step": step, "origin": [x, y], "lowest": low, "highest": high},
    )  # fmt: skip
    return Ground(x, y, step, height, high)


def _picture(spec: SettingsTable, file: Path) -> Array:
    if "unit" in spec:
        raise spec.fault("is for tables; the heights of a picture are those of range", "unit")
    lowest, highest = spec.quantities("range", 2, "m", usual=_FAR)
    if not lowest < highest:
        raise spec.fault(
            f"is [{lowest:g}, {highest:g}]; expected the height of a black pixel (0), then a "
            "larger one of a white pixel (65535)", "range",
        )  # fmt: skip
    return read_height_picture(file, lowest, highest)


def _table(spec: SettingsTable, file: Path) -> Array:
    if "range" in spec:
        raise spec.fault("is for pictures; a table holds heights, in m or in unit", "range")
    stated = "unit" in spec
    _, factor = spec.factor("unit", "m")
    height = factor * read_height_table(file)
    if not stated and np.ptp(height) > MOST_RELIEF:
        middle = np.abs(height - np.median(height))
        row, column = np.unravel_index(middle.argmax(), height.shape)
        raise DataError(
            f"cell {column + 1} is {height[row, column]:g}, and heights differ by "
            f"{np.ptp(height):g} m, which is improbable under this robot; if they are in "
            'millimetres, add unit = "mm" (or unit = "m") beside heights; a decimal comma between '
            "commas is read as two cells",
            file=file, row=int(row) + 1,
        )  # fmt: skip
    return height


def _areas(
    table: SettingsTable, parts: _Parts
) -> tuple[tuple[SlipArea, ...], tuple[NamedSlip, ...]]:
    if "area" not in table:
        return (), ()
    found = _tables(table, "area", table.value("area"), _MOST_AREAS, "polygon and slip")
    read = [_area(each, Path(table.file).parent) for each in found]
    for number, (area, slip) in enumerate(read, start=1):
        (x0, y0), (x1, y1) = area.polygon.min(axis=0), area.polygon.max(axis=0)
        parts.what.append(
            f"area {number}: slip {slip.title}, {counted(len(area.polygon), 'corner')}, x {x0:g} "
            f"to {x1:g} m, y {y0:g} to {y1:g} m"
        )
    parts.settings["area"] = [
        {"polygon": area.polygon.tolist(), "slip": slip.text, "source": slip.source}
        for area, slip in read
    ]
    return tuple(area for area, _ in read), tuple(slip for _, slip in read)


def _area(table: SettingsTable, folder: Path) -> tuple[SlipArea, NamedSlip]:
    polygon = _polygon(table)
    text = table.text("slip", least=1)
    try:
        own = text == THESIS or coulomb_numbers(text) is not None
    except SettingsError as error:
        raise table.fault(error.problem, "slip") from error
    try:
        slip = parse_slip(text if own else str(folder / text), with_walks=False)
    except (SettingsError, FileNotFoundError) as error:
        problem = str(error).removeprefix("--slip: ")
        raise table.fault(problem, "slip") from error
    return SlipArea(polygon, slip, slip.title), slip


def _polygon(table: SettingsTable) -> Array:
    """Read the corners of an area, a list of [x, y]."""
    found = table.value("polygon")
    if not isinstance(found, list) or not all(
        isinstance(each, list) and len(each) == 2 for each in found
    ):
        raise table.fault(
            f"found {found!r}; expected a list of corners [x, y], such as "
            "[[0.5, -1], [1, -1], [1, 1], [0.5, 1]]", "polygon",
        )  # fmt: skip
    corners = [
        table.as_table(f"corner[{i + 1}]", dict(zip("xy", each, strict=True)))
        for i, each in enumerate(found)
    ]
    polygon = np.array([
        [each.quantity(axis, "m", usual=_FAR) for axis in "xy"] for each in corners
    ]).reshape(-1, 2)  # fmt: skip
    try:
        require_polygon(polygon)
    except DomainError as error:
        raise table.fault(str(error), "polygon") from error
    return polygon


def _tables(
    table: SettingsTable, key: str, found: object, most: int, keys: str
) -> list[SettingsTable]:
    """Return an array of tables; raise `SettingsError` if it is none, or has too many."""
    if not isinstance(found, list) or not 1 <= len(found) <= most:
        raise table.fault(f"expected 1 to {most} tables [[{key}]] with {keys}", key)
    return [table.as_table(f"{key}[{i + 1}]", each) for i, each in enumerate(found)]
