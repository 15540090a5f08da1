# SPDX-License-Identifier: MIT
"""The text of a plan with other points: its other tables and its comments stay as they are."""

from pathlib import Path
from typing import Final

import tomlkit
from tomlkit.items import Array

from model.toml_table import parse_toml
from rig.experiment.plan import Plan
from rig.experiment.plan_reading import parse_plan
from zebro_lab.files.errors import DataError
from zebro_lab.files.settings_table import SettingsTable

_LINE: Final = 12  # numbers in a line


def with_points(text: str, plan: Plan, *, file: Path) -> str:
    """Return a plan's text with the points of another plan.

    Args:
        text: The text, a valid plan.
        plan: The plan whose points it is to have; the rest of both is the same.
        file: File of the text, for messages.

    Raises:
        DataError: The result is not that plan, as of a text that states its points in an unusual
            way.
    """
    points = plan.points
    document = tomlkit.parse(text)
    table = document["points"]
    wanted = {
        "loads": _numbers(points.loads),
        "slips": _numbers(points.slips),
        "length": "duration",
        "duration": points.duration,
        "order": points.order,
        **({"repeats": points.repeats} if "repeats" in table else {}),  # pyright: ignore[reportOperatorIssue]
    }
    table.pop("turns", None)  # pyright: ignore[reportAttributeAccessIssue]
    for key, value in wanted.items():
        table[key] = value  # pyright: ignore[reportIndexIssue]
    changed = tomlkit.dumps(document)
    if parse_plan(SettingsTable(parse_toml(changed.encode()), file=file)) != plan:
        raise DataError(
            "states its points in a way that cannot be replaced; write [points] as a table, as in "
            "examples/plan-thesis.toml",
            file=file,
        )
    return changed


def _numbers(values: tuple[float, ...]) -> Array:
    """Return an array of numbers, of many with several in a line."""
    rows = [values[i : i + _LINE] for i in range(0, len(values), _LINE)]
    lines = ",\n    ".join(", ".join(map(repr, row)) for row in rows)
    body = f"[{lines}]" if len(rows) == 1 else f"[\n    {lines},\n]"
    array: Array = tomlkit.parse(f"x = {body}\n")["x"]  # pyright: ignore[reportAssignmentType]
    return array
