# SPDX-License-Identifier: MIT
"""Plans of experiments that are short enough for tests."""

from pathlib import Path

THESIS_PLAN = Path(__file__).parents[2] / "examples" / "plan-thesis.toml"

_SHORT = {
    "loads": "[8.0]",
    "slips": "[0.05, 0.6]",
    "duration": "0.3",
    "tare_duration": "0.3",
    "check_every": "0",
    # A busy machine may hold a process up.
    "silence": "3.0\nreading_age = 3.0\nguards_off = "
    '["silence", "reading_age", "speed_error_time"]',
    "speed_error_time": "2.0",
}
LENIENT = {"friction": "0.4", "slip_drift": "0.05", "friction_drift": "0.5"}
"""Criteria of steady and good points that records of a fraction of a second meet."""


def short_plan(folder: Path, **changes: str) -> Path:
    """Write the thesis's plan with two points of 0.3 s at one load, and return the file.

    Args:
        folder: Folder of the file.
        changes: Further values, as TOML, by key.
    """
    wanted = _SHORT | changes
    lines = []
    for line in THESIS_PLAN.read_text().splitlines():
        key = line.partition(" = ")[0]
        lines.append(f"{key} = {wanted.pop(key)}" if key in wanted else line)
    assert not wanted, f"not in the plan: {list(wanted)}"
    file = folder / "plan.toml"
    file.write_text("\n".join(lines) + "\n")
    return file
