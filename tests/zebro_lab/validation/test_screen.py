# SPDX-License-Identifier: MIT
"""What is printed of a validation has the errors of each walk, with units, and what they mean."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from model.judgement import judge_tilt
from model.metrics.consistency import Consistency
from support.judged_walks import judged_walk
from zebro_lab.validation.folder import summarise_runs
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.validation.screen import print_validated
from zebro_lab.validation.stage import Validated

CONSISTENCY = (
    Consistency("nees", 2.5, 0.2, 7.4, 0.5),
    Consistency("along", 0.001, -0.004, 0.005, 0.8),
    Consistency("cross", 0.02, -0.01, 0.012, 0.004),
    Consistency("yaw", np.radians(0.5), np.radians(-1.0), np.radians(1.0), 0.3),
)


def run_of(name: str, *, off: float) -> JudgedRun:
    run = judged_walk(name, off=off)
    prediction, *baselines = run.rows
    return replace(run, rows=(replace(prediction, consistency=CONSISTENCY), *baselines))


RUN = run_of("one", off=0.02)


def printed(*runs, summary=(), source="real") -> str:
    console = Console(file=io.StringIO(), width=200)
    print_validated(console, Validated(runs or (RUN,), summary, source), Path("out"))
    return console.file.getvalue()


def rows(text: str) -> dict[str, list[str]]:
    return {line.split()[0]: line.split() for line in text.splitlines() if line.strip()}


def test_a_warning_stands_before_the_errors_it_is_about():
    warned = replace(RUN, notes=("tracked", "WARNING: not testable"))
    text = printed(warned)
    assert text.startswith("one: WARNING: not testable\n")
    assert text.count("WARNING") == 1
    assert "tracked" in text


def test_every_model_has_its_errors_in_millimetres_and_degrees():
    text = printed()
    assert f"one: {RUN.rows[0].errors.poses} poses, 0.400 m" in text
    for row in RUN.rows:
        line = next(each for each in text.splitlines() if each.strip().startswith(row.name))
        e, cells = row.errors, line.strip().removeprefix(row.name).split()
        assert cells[0] == f"{1000 * e.ate:.1f}"
        assert cells[1] == f"{100 * e.ate_of_length:.2f}"
        assert cells[2:7] == [
            f"{1000 * e.along:.1f}", f"{1000 * e.cross:.1f}", f"{np.degrees(e.yaw):.2f}",
            f"{1000 * e.final_distance:.1f}", f"{1000 * e.ate_aligned:.1f}",
        ]  # fmt: skip
    assert rows(text)["prediction"][1] == "20.0"  # mm to the side, as it was made
    assert rows(text)["track"][1] == "straight"


def test_the_coverage_of_a_band_is_told():
    text, row = printed(), RUN.rows[0]
    for level, (x, y, yaw) in zip(row.scores.levels, row.scores.coverage, strict=True):
        assert f"coverage of the {level:.0%} band: x {x:.0%}, y {y:.0%}, yaw {yaw:.0%}" in text


def test_statistics_of_a_band_have_units_and_what_is_expected():
    text = printed()
    for line in (
        "error relative to predicted uncertainty (NEES) 2.5, expected 0.2 to 7.4: consistent (p "
        "0.5)",
        "mean error along the path 1 mm, expected -4 to 5 mm: consistent (p 0.8)",
        "mean error across the path 20 mm, expected -10 to 12 mm: NOT consistent (p 0.004)",
        "mean error of yaw 0.5 deg, expected -1 to 1 deg: consistent (p 0.3)",
    ):
        assert line in text


def test_a_path_without_a_band_has_no_coverage():
    text = printed(replace(RUN, band=None))
    assert "coverage" not in text
    assert "consistent" not in text


def test_means_over_walks_have_their_intervals():
    runs = tuple(run_of(name, off=off) for name, off in (("a", 0.02), ("b", 0.03)))
    assert "means over" not in printed(*runs)
    summary = tuple(summarise_runs(runs, rng=np.random.default_rng(1)))
    text = printed(*runs, summary=summary)
    first = summary[0]
    mean, low, high = first.interval
    assert f"{first.model}: {first.metric} {mean:.4g} ({low:.4g} to {high:.4g})" in text
    assert "means over 2 walks, 90 % intervals over walks" in text


@pytest.mark.parametrize(("source", "simulated"), [("real", False), ("real, sim:x", True)])
def test_simulated_data_are_told_and_notes_are_no_markup(source, simulated):
    text = printed(replace(RUN, notes=("[bold]note",)), source=source)
    assert ("SIMULATED: " in text) == simulated
    assert "[bold]note" in text
    assert text.rstrip().endswith("written to out")


def test_errors_of_roll_and_pitch_are_told_with_their_bias(walked):
    angles = walked.orientation[:, :2] + np.radians([1.0, 0.0])
    text = printed(replace(RUN, tilt=judge_tilt(walked, walked.t, angles)))
    assert "roll: error against the IMU 0.00 deg rms without bias, bias -1.00 deg" in text
    assert "pitch: error against the IMU 0.00 deg rms without bias, bias +0.00 deg" in text
    assert "roll: " not in printed()


def test_a_share_that_is_not_known_is_not_testable():
    prediction, *baselines = RUN.rows
    coverage = prediction.scores.coverage.copy()
    coverage[:, 2] = np.nan
    unknown = replace(prediction, scores=replace(prediction.scores, coverage=coverage))
    text = printed(replace(RUN, rows=(unknown, *baselines)))
    assert text.count("yaw not testable (of") == len(prediction.scores.levels)
    assert "nan%" not in text


def test_errors_of_yaw_without_headings_are_no_numbers():
    rows = [replace(row, errors=replace(row.errors, yaw=float("nan"))) for row in RUN.rows]
    text = printed(replace(RUN, rows=tuple(rows)))
    assert text.count("no heading") == len(rows)
    assert "nan" not in text
