# SPDX-License-Identifier: MIT
"""The rounds of an adaptive experiment, and the file that tells them: `adaptive.json`."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from zebro_lab.adaptive.wanted import Wanted
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.documents import read_json_document, require_object
from zebro_lab.files.errors import AlreadyExists, DataError, SettingsError

ROUNDS_FILE: Final = "adaptive.json"
CALIBRATION: Final = "calibration"
_ADVICE: Final = "restore it, or begin anew with another --data"


@dataclass(frozen=True)
class Round:
    """A finished round.

    Attributes:
        number: Number of the round, from 1.
        seconds: Duration of its plan, as `rig plan` estimates it [s].
        points: Number of its points, check points included.
        refused: Number of points of which every attempt was rejected.
        half_widths: Half width of the 90 % interval of each target after it, by the target's text;
            NaN for the end of a walk.
        doubt: Headline of the fit's verdict if it cannot be trusted; else empty.
    """

    number: int
    seconds: float
    points: int
    refused: int
    half_widths: dict[str, float]
    doubt: str = ""


def folder_of(data: Path, number: int) -> Path:
    """Return the folder of the experiment of a round."""
    return data / f"round-{number:02d}"


def suggestion_of(data: Path, number: int) -> Path:
    """Return the folder of the suggestion that a later round than the first measures."""
    return data / f"suggested-{number:02d}"


def settings_of(wanted: Sequence[Wanted], budget: float, plan: str) -> dict[str, Any]:
    """Return what a resumed experiment must share with the stopped one.

    Args:
        wanted: The targets with their half widths.
        budget: Time of all rounds [s].
        plan: Text of the plan of the first round.
    """
    return {
        "targets": {each.text: each.half_width for each in wanted}, "budget_s": budget, "plan": plan
    }  # fmt: skip


def write_rounds(data: Path, settings: dict[str, Any], rounds: Sequence[Round]) -> None:
    """Write `adaptive.json`, whole or not at all."""
    content = {"settings": settings, "rounds": [_plain(each) for each in rounds]}
    atomic_write_text(data / ROUNDS_FILE, json.dumps(content, indent=2, allow_nan=False) + "\n")


def begin_or_resume(data: Path, settings: dict[str, Any], *, resume: bool) -> list[Round]:
    """Begin an adaptive experiment in a folder, or return the rounds that are finished there.

    Raises:
        AlreadyExists: The folder holds one, and `resume` is not set.
        SettingsError: It has other targets, budget or plan.
        DataError: `adaptive.json` is damaged.
    """
    file = data / ROUNDS_FILE
    if not file.exists():
        if folder_of(data, 1).exists():
            raise AlreadyExists(
                f"{data} holds rounds of an adaptive experiment, but {ROUNDS_FILE} is missing; "
                f"{_ADVICE}"
            )
        data.mkdir(parents=True, exist_ok=True)
        write_rounds(data, settings, ())
        return []
    if not resume:
        raise AlreadyExists(
            f"{data} holds an adaptive experiment; go on with it with --resume, or choose another "
            "folder with --data"
        )
    content = require_object(read_json_document(file, advice=_ADVICE), file)
    _require_same(content.get("settings"), settings, file)
    return _rounds(content.get("rounds"), file)


def _require_same(found: object, settings: dict[str, Any], file: Path) -> None:
    for key, value in settings.items():
        other = found.get(key) if isinstance(found, dict) else None
        if other != value:
            shown = "another" if key == "plan" else f"{value} now and {other} there"
            raise SettingsError(
                f"{key} is {shown}; give the same command with --resume, or another --data",
                file=file,
            )


def _rounds(found: Any, file: Path) -> list[Round]:
    try:
        return [_round(each) for each in found]
    except (TypeError, KeyError, ValueError, AttributeError) as error:
        raise DataError(f"holds no rounds; {_ADVICE}", file=file) from error


def _round(found: dict[str, Any]) -> Round:
    widths = {
        str(name): math.nan if width is None else float(width)
        for name, width in found["half_widths"].items()
    }
    return Round(
        int(found["number"]), float(found["seconds"]), int(found["points"]),
        int(found["refused"]), widths, str(found["doubt"]),
    )  # fmt: skip


def _plain(each: Round) -> dict[str, Any]:
    widths = {n: None if math.isnan(width) else width for n, width in each.half_widths.items()}
    return {**asdict(each), "half_widths": widths}
