# SPDX-License-Identifier: MIT
"""Read and format `annotations.toml`: a person's annotations of photographs, used in tracking.

New corrections are appended; a new template of a photograph, or a new click, replaces the earlier.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from tracking.body import TopPlate
from tracking.corrections import Correction, correction_from, plain
from tracking.errors import TrackingError
from tracking.photos.scene import Click, MarkedTop
from zebro_lab.files.settings_table import SettingsTable, fill_in, read_settings

ANNOTATIONS_FILE = "annotations.toml"


@dataclass(frozen=True)
class Annotations:
    """A person's annotations of photographs.

    Attributes:
        templates: Corners of the robot's top, and its size, each in another photograph.
        clicks: Clicked pixel (u, v) of each floor point, by photograph and the point's name [px].
        corrections: Corrections of the tracker's poses, in the order in which they are applied.
    """

    templates: tuple[MarkedTop, ...] = ()
    clicks: Mapping[str, Mapping[str, Click]] = field(default_factory=dict)
    corrections: tuple[Correction, ...] = ()

    def merged(self, later: "Annotations") -> "Annotations":
        """Merge with later annotations, which replace earlier ones of the same thing.

        Clicks are replaced by photograph and point, templates by photograph; corrections are
        appended.
        """
        tops = {top.photo: top for top in (*self.templates, *later.templates)}
        names = {**self.clicks, **later.clicks}
        clicks = {
            photo: {**self.clicks.get(photo, {}), **later.clicks.get(photo, {})} for photo in names
        }
        return replace(
            self,
            templates=tuple(tops.values()),
            clicks=clicks,
            corrections=self.corrections + later.corrections,
        )


def read_annotations(file: Path) -> Annotations:
    """Read and validate an `annotations.toml`.

    Raises:
        NotFound: The file does not exist.
        SettingsError: The file is not TOML, or holds an unknown key or an impossible value.
    """
    table = read_settings(file, advice="`zebro-lab annotate PHOTOS` writes one")
    templates = _templates(table)
    clicks = table.table("clicks")
    points = {photo: clicks.table(photo) for photo in clicks.unread}
    by_photo = {
        photo: {name: _pixel(own, name) for name in own.unread} for photo, own in points.items()
    }
    annotations = Annotations(templates, by_photo, _corrections(table))
    table.finish()
    return annotations


def _templates(table: SettingsTable) -> tuple[MarkedTop, ...]:
    """Read `[template]` or `[[template]]` tables; `SettingsError` if two are of one photograph."""
    if "template" not in table:
        return ()
    found = table.value("template", [])
    if not isinstance(found, list):
        return (_template(table.as_table("template", found)),)
    tops = tuple(
        _template(table.as_table(f"template[{k}]", each)) for k, each in enumerate(found, 1)
    )
    photos = [top.photo for top in tops]
    twice = next((photo for photo in photos if photos.count(photo) > 1), None)
    if twice is not None:
        raise table.fault(f"'{twice}' is annotated twice; remove one of the tables", "template")
    return tops


def _template(table: SettingsTable) -> MarkedTop:
    """Read one template: corners [px] and size [m] of the robot's top, optional margins [m].

    Raises:
        SettingsError: There are not four corners, or a value is missing or invalid.
    """
    found = table.value("corners_px", [])
    if not isinstance(found, list) or len(found) != 4:
        raise table.fault("expected four pixels: front left, front right, rear right, rear left "
                          "of the robot's top", "corners_px")  # fmt: skip
    rows = table.as_table("corners_px", {str(k): row for k, row in enumerate(found)})
    corners = tuple(_pixel(rows, str(k)) for k in range(4))
    optional = {
        key: table.quantity(key, "m") for key in ("centre_x", "margin", "front_margin")
        if key in table
    }  # fmt: skip
    try:
        plate = TopPlate(
            *(table.quantity(key, "m") for key in ("length", "width", "height")), **optional
        )
    except TrackingError as error:
        raise table.fault(str(error)) from error
    sd = table.quantity("corner_sd_px", "dimensionless", default=MarkedTop.corner_sd_px, above=0.0)
    edges = table.value("edges", True)
    if not isinstance(edges, bool):
        raise table.fault(f"found {edges!r}; expected true or false", "edges")
    return MarkedTop(table.text("photo", least=1), corners, plate, sd, edges)


def _pixel(table: SettingsTable, key: str) -> Click:
    """Read a pixel: a list of its column u and row v [px]."""
    u, v = table.quantities(key, 2, "dimensionless")
    return u, v


def _corrections(table: SettingsTable) -> tuple[Correction, ...]:
    """Read the `[[correction]]` tables in order; a `SettingsError` counts them from 1."""
    entries = table.value("correction", [])
    if not isinstance(entries, list):
        raise table.fault("expected [[correction]] tables", "correction")
    corrections = []
    for number, entry in enumerate(entries, 1):
        key = f"correction[{number}]"
        if not isinstance(entry, dict):
            raise table.fault(f"found {entry!r}; expected a table", key)
        try:
            corrections.append(correction_from(entry))
        except TrackingError as error:
            raise table.fault(str(error), key) from error
    return tuple(corrections)


def render_annotations(annotations: Annotations) -> str:
    """Format annotations as commented TOML, from which `read_annotations` reads the same."""
    template, values = _HEADING, {}
    if len(annotations.templates) == 1:
        template += _TEMPLATE_SECTION
        values["template"] = _template_values(annotations.templates[0])
    elif annotations.templates:
        values["template"] = [_template_values(each) for each in annotations.templates]
    if annotations.clicks:
        values["clicks"] = annotations.clicks
    if annotations.corrections:
        values["correction"] = [plain(correction) for correction in annotations.corrections]
    return fill_in(template, values)


_HEADING = """\
# A person's annotations of photographs; `zebro-lab track --annotations` applies them.
# Pixels: the centre of the first one is (0, 0). Lengths in m, angles in rad.
"""
_TEMPLATE_SECTION = """
[template]  # the robot's top in one photograph
photo = ""
corners_px = []  # front left, front right, rear right, rear left
"""


def _template_values(template: MarkedTop) -> Mapping[str, Any]:
    """Return the keys of a `[template]` table: photograph, corners [px] and sizes [m]."""
    plate = template.plate
    return {
        "photo": template.photo, "corners_px": template.corners_px,
        "length": plate.length, "width": plate.width, "height": plate.height,
        "centre_x": plate.centre_x, "margin": plate.margin, "front_margin": plate.front_margin,
        "corner_sd_px": template.corner_sd_px, "edges": template.edges,
    }  # fmt: skip
