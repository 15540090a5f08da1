# SPDX-License-Identifier: MIT
"""The screen tells what is expected, the points, and what they assume."""

import io
from pathlib import Path

from rich.console import Console

from support.suggestions import suggested
from zebro_lab.suggest.screen import print_suggested


def printed(found):
    console = Console(file=io.StringIO(), width=120)
    print_suggested(console, found, Path("out"))
    return console.file.getvalue()


def test_the_table_compares_now_the_plan_and_the_suggestion():
    found = suggested()
    text = printed(found)
    (row,) = [line for line in text.splitlines() if line.split()[:1] == ["slip_stiffness"]]
    expected = found.expected[0]
    sds = (expected.sd_now, expected.sd_plan, expected.sd_suggested)
    less = f"{100 * (1 - expected.sd_suggested / expected.sd_plan):.0f}"
    assert row.split() == ["slip_stiffness", *(f"{sd:.3g}" for sd in sds), less, "%"]
    assert "after the plan" in text
    minutes, seconds = divmod(round(found.proposal.seconds), 60)
    assert f"suggestion, {minutes} min {seconds} s" in text
    assert "calibration of SIMULATED data, source 'sim:test'" in text
    assert "next: zebro-lab rig plan out/plan.toml" in text
