# SPDX-License-Identifier: MIT
"""Plans of experiments that are short enough for tests."""

from pathlib import Path

THESIS_PLAN = Path(__file__).parents[2] / "examples" / "plan-thesis.toml"

_SHORT = {
    "loads = [2.13, 6.63, 8.13, 12.75]": "loads = [8.0]",
    "slips = { first = 0.0, last = 1.0, count = 62 }": "slips = [0.05, 0.6]",
    "duration = 1.0": "duration = 0.3",
    "tare_duration = 10.0": "tare_duration = 0.3",
    "check_every = 62": "check_every = 0",
    # A busy machine may hold a process up.
    "silence = 0.25": "silence = 3.0\nreading_age = 3.0\nguards_off = "
    '["silence", "reading_age", "speed_error_time"]',
    "speed_error_time = 0.2": "speed_error_time = 2.0",
}


def short_plan(folder: Path) -> Path:
    """Write the thesis's plan with two points of 0.3 s at one load, and return the file."""
    text = THESIS_PLAN.read_text()
    for old, new in _SHORT.items():
        assert old in text
        text = text.replace(old, new)
    file = folder / "plan.toml"
    file.write_text(text)
    return file
