# SPDX-License-Identifier: MIT
"""Result of one check of a machine, and its severity."""

from dataclasses import dataclass
from enum import StrEnum


class Grade(StrEnum):
    """Severity of a finding: OK, NOTE (matters to some), BROKEN (a needed part is missing)."""

    OK = "ok"
    NOTE = "note"
    BROKEN = "BROKEN"


@dataclass(frozen=True)
class Finding:
    """Result of one check.

    Attributes:
        state: Severity.
        what: Subject of the check, such as `python` or `CAN can0`.
        text: What was found; unless OK, also the remedy.
    """

    state: Grade
    what: str
    text: str
