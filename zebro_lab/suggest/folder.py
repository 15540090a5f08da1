# SPDX-License-Identifier: MIT
"""Suggested points, what is expected of them, and the result folder of `rig suggest`."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import pandas as pd
import tomlkit
from tomlkit.items import Array

from model.toml_table import parse_toml
from rig.experiment.plan import Plan
from rig.experiment.plan_reading import parse_plan
from zebro_lab.files.errors import DataError
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.result_folder import ResultKind
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.suggest.proposal import Knowledge, Proposal

PLAN: Final = "plan.toml"
EXPECTED: Final = "expected.csv"
PICTURE: Final = "suggested"
SUGGESTED: Final = ResultKind(
    "rig-suggest", "rig suggest", (PLAN, EXPECTED, *in_every_format(PICTURE))
)
"""Kind of folder that `rig suggest` writes."""


@dataclass(frozen=True)
class Expected:
    """Standard deviations of a part of a target.

    Attributes:
        target: The target, as it was asked for.
        part: Name of the part.
        unit: Unit of the standard deviations, as pint spells it; "dimensionless" of forces, whose
            standard deviations are relative.
        sd_now: With the calibration's data.
        sd_plan: After the plan as it is.
        sd_suggested: After the suggestion.
    """

    target: str
    part: str
    unit: str
    sd_now: float
    sd_plan: float
    sd_suggested: float


@dataclass(frozen=True)
class Suggested:
    """Suggested points, and what is expected of them.

    Attributes:
        plan: The plan as it is.
        plan_seconds: Its estimated duration [s].
        proposal: The proposed points.
        expected: Standard deviations of each part of each target.
        knowledge: What was known before.
        calibration: Name of the calibration's folder.
        source: Source of the calibration's data.
        notes: What the proposal assumes, one line each.
    """

    plan: Plan
    plan_seconds: float
    proposal: Proposal
    expected: tuple[Expected, ...]
    knowledge: Knowledge
    calibration: str
    source: str
    notes: tuple[str, ...]


def points_of(suggested: Suggested) -> dict[str, object]:
    """Return the proposed points in numbers, for manifest and document."""
    proposal = suggested.proposal
    return {
        "loads_N": list(proposal.plan.points.loads),
        "slips": [
            {"slip_ratio": float(slip), "points": int(count)}
            for slip, count in zip(proposal.slips, proposal.counts, strict=True)
        ],
        "point_s": proposal.plan.points.duration,
        "duration_s": proposal.seconds,
        "plan_duration_s": suggested.plan_seconds,
        "expected": [asdict(row) for row in suggested.expected],
    }


def write_expected(file: Path, rows: Sequence[Expected]) -> None:
    """Write one row a part of a target as CSV.

    Args:
        file: File to write.
        rows: The parts, at least one.
    """
    pd.DataFrame(map(asdict, rows)).to_csv(
        file, index=False, float_format="%.6g", lineterminator="\n"
    )


_LINE: Final = 12  # numbers in a line


def with_points(text: str, plan: Plan, *, file: Path) -> str:
    """Return a plan's text with the points of another plan.

    Args:
        text: The text, a valid plan.
        plan: The plan whose points it is to have; the rest of both is the same.
        file: File of the text, for messages.

    Raises:
        DataError: The result is not that plan, because the text states its points in an unusual
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
    """Return a TOML array of numbers, with line breaks if there are over `_LINE`."""
    rows = [values[i : i + _LINE] for i in range(0, len(values), _LINE)]
    lines = ",\n    ".join(", ".join(map(repr, row)) for row in rows)
    body = f"[{lines}]" if len(rows) == 1 else f"[\n    {lines},\n]"
    array: Array = tomlkit.parse(f"x = {body}\n")["x"]  # pyright: ignore[reportAssignmentType]
    return array
