# SPDX-License-Identifier: MIT
"""The screen tells what is expected, the points, and what they assume."""

import io
from dataclasses import replace
from pathlib import Path

from rich.console import Console

from support.suggestions import suggested
from zebro_lab.suggest.folder import Expected
from zebro_lab.suggest.screen import lines, print_suggested


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


def test_points_are_told_with_how_often():
    found = suggested()
    points, assumed = lines(found)
    assert assumed == "assumes much"
    assert points.startswith(f"{2 * found.proposal.counts.sum()} points of ")
    assert "at loads of 3, 9 N each slips of -0.2, " in points
    assert " times)" in points


def test_units_and_parts_of_walks_are_told():
    row = Expected("walk:run", "heading", "rad", 0.5, 0.2, 0.1)
    text = printed(replace(suggested(), expected=(row,)))
    assert "walk:run heading" in text
    assert "0.5 rad" in text


def test_relative_sds_of_forces_are_in_percent():
    row = Expected("force@0.02:8", "force@0.02:8", "dimensionless", 0.051, 0.02, 0.01)
    assert " 5.1 % " in printed(replace(suggested(), expected=(row,)))
