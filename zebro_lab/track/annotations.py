# SPDX-License-Identifier: MIT
"""`annotations.toml`: what a person said about photographs, replayed every time they are tracked.

Nothing in it is ever overwritten: new corrections go to its end.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from tracking.body import TopPlate
from tracking.corrections import Correction, correction_from, plain
from tracking.errors import TrackingError
from tracking.photos.scene import Click, MarkedTop
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.toml_table import TomlTable, listed, quoted, read_toml, spelled

ANNOTATIONS_FILE = "annotations.toml"
_TOP = ("template", "clicks", "correction")
_TEMPLATE = (
    "photo", "corners_px", "length", "width", "height", "centre_x", "margin", "front_margin",
)  # fmt: skip


@dataclass(frozen=True)
class Annotations:
    """What a person said.

    Attributes:
        template: The robot's top in one photograph; None where nobody marked it.
        clicks: By photograph, points of the floor by name, where they were clicked [px].
        corrections: What is wrong in what the tracker finds, in the order in which it was said.
    """

    template: MarkedTop | None = None
    clicks: Mapping[str, Mapping[str, Click]] = field(default_factory=dict)
    corrections: tuple[Correction, ...] = ()

    def merged(self, later: "Annotations") -> "Annotations":
        """Return both: the later template and clicks prevail, later corrections follow."""
        names = {**self.clicks, **later.clicks}
        clicks = {
            photo: {**self.clicks.get(photo, {}), **later.clicks.get(photo, {})} for photo in names
        }
        return replace(
            self,
            template=later.template or self.template,
            clicks=clicks,
            corrections=self.corrections + later.corrections,
        )


def read_annotations(file: Path) -> Annotations:
    """Read and check an `annotations.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is no TOML, or holds an unknown key or an impossible value.
    """
    table = read_toml(file, advice="`zebro-lab annotate PHOTOS` writes one")
    table.require_known(_TOP)
    template = _template(table.table("template")) if "template" in table else None
    clicks = table.table("clicks")
    by_photo = {photo: _clicks(clicks.table(photo)) for photo in clicks.values}
    return Annotations(template, by_photo, _corrections(table))


def _template(table: TomlTable) -> MarkedTop:
    table.require_known(_TEMPLATE)
    found = table.values.get("corners_px")
    if not isinstance(found, list) or len(found) != 4:
        raise table.error("corners_px", "expected four pixels: front left, front right, rear "
                                        "right, rear left of the robot's top")  # fmt: skip
    rows = TomlTable(table.file, {str(k): row for k, row in enumerate(found)}, f"{table.where}")
    corners = tuple(_pixel(rows, str(k)) for k in range(4))
    optional = {
        key: table.number(key, "m") for key in ("centre_x", "margin", "front_margin")
        if key in table
    }  # fmt: skip
    try:
        plate = TopPlate(
            table.number("length", "m"), table.number("width", "m"), table.number("height", "m"),
            **optional,
        )  # fmt: skip
    except TrackingError as error:
        raise SettingsError(str(error), file=table.file, key="template") from error
    return MarkedTop(table.text("photo"), corners, plate)


def _clicks(table: TomlTable) -> dict[str, Click]:
    return {name: _pixel(table, name) for name in table.values}


def _pixel(table: TomlTable, key: str) -> Click:
    u, v = table.numbers(key, 2)
    return u, v


def _corrections(table: TomlTable) -> tuple[Correction, ...]:
    entries = table.values.get("correction", [])
    if not isinstance(entries, list):
        raise table.error("correction", "expected [[correction]] tables")
    corrections = []
    for number, entry in enumerate(entries, 1):
        where = table.as_table(f"correction[{number}]", entry)
        try:
            corrections.append(correction_from(where.values))
        except TrackingError as error:
            raise SettingsError(str(error), file=table.file, key=where.where.rstrip(".")) from error
    return tuple(corrections)


def render_annotations(said: Annotations) -> str:
    """Write annotations as commented TOML that `read_annotations` reads back."""
    parts = [_HEADING]
    if said.template is not None:
        parts.append(_template_section(said.template))
    for photo, clicks in said.clicks.items():
        lines = [f"{quoted(name)} = {listed(click)}" for name, click in clicks.items()]
        parts.append("\n".join([f"[clicks.{quoted(photo)}]", *lines]))
    parts += [_correction_section(plain(correction)) for correction in said.corrections]
    return "\n\n".join(parts) + "\n"


_HEADING = """\
# What a person said about photographs; `zebro-lab track --annotations` replays it.
# Pixels: the centre of the first one is (0, 0). Lengths in m, angles in rad."""


def _template_section(template: MarkedTop) -> str:
    plate = template.plate
    corners = ", ".join(listed(corner) for corner in template.corners_px)
    sizes = {
        "length": plate.length, "width": plate.width, "height": plate.height,
        "centre_x": plate.centre_x, "margin": plate.margin, "front_margin": plate.front_margin,
    }  # fmt: skip
    return "\n".join([
        "[template]  # the robot's top in one photograph",
        f"photo = {quoted(template.photo)}",
        f"corners_px = [{corners}]  # front left, front right, rear right, rear left",
        *(f"{name} = {spelled(value)}" for name, value in sizes.items()),
    ])  # fmt: skip


def _correction_section(entry: Mapping[str, Any]) -> str:
    lines = [f"{key} = {_value(value)}" for key, value in entry.items()]
    return "\n".join(["[[correction]]", *lines])


def _value(value: str | float | list[str]) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(quoted, value))}]"
    return quoted(value) if isinstance(value, str) else spelled(value)
