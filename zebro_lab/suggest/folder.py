# SPDX-License-Identifier: MIT
"""The result folder of `rig suggest`: the plan, what it is expected to tell, and a picture."""

import csv
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.result_folder import ResultKind

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


def write_expected(file: Path, rows: Sequence[Expected]) -> None:
    """Write one row a part of a target as CSV.

    Args:
        file: File to write.
        rows: The parts, at least one.
    """
    with file.open("w", encoding="utf-8", newline="") as text:
        writer = csv.DictWriter(text, asdict(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            cells = asdict(row).items()
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in cells})
