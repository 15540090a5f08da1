# SPDX-License-Identifier: MIT
"""What is printed of a validation has the errors of each walk, with units, and what they mean."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
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


def test_warnings_are_first_simulated_data_are_told_and_notes_are_no_markup():
    text = printed(replace(RUN, notes=("[bold]tracked", "WARNING: not testable")))
    assert text.startswith("one: WARNING: not testable\n")
    assert text.count("WARNING") == 1
    assert "[bold]tracked" in text
    assert text.rstrip().endswith("written to out")
    assert "SIMULATED: real, sim:x" in printed(source="real, sim:x")


def test_every_model_has_its_errors_in_millimetres_and_degrees():
    text = printed()
    assert f"one: {RUN.rows[0].errors.poses} poses, 0.400 m" in text
    for row in RUN.rows:
        line = next(each for each in text.splitlines() if each.strip().startswith(row.name))
        e, cells = row.errors, line.strip().removeprefix(row.name).split()
        millimetres = (e.ate, e.along, e.cross, e.final_distance, e.ate_aligned)
        assert [cells[k] for k in (0, 2, 3, 5, 6)] == [f"{1000 * each:.1f}" for each in millimetres]
        assert (cells[1], cells[4]) == (f"{100 * e.ate_of_length:.2f}", f"{np.degrees(e.yaw):.2f}")
    assert rows(text)["prediction"][1] == "20.0"  # mm to the side, as it was made
    assert rows(text)["track"][1] == "straight"


def test_coverage_and_statistics_of_a_band_have_units_and_what_is_expected():
    text, row = printed(), RUN.rows[0]
    for level, (x, y, yaw) in zip(row.scores.levels, row.scores.coverage, strict=True):
        assert f"coverage of the {level:.0%} band: x {x:.0%}, y {y:.0%}, yaw {yaw:.0%}" in text
    for part in (
        "(NEES) 2.5, expected 0.2 to 7.4: consistent (p 0.5)",
        "along the path 1 mm, expected -4 to 5 mm: consistent (p 0.8)",
        "across the path 20 mm, expected -10 to 12 mm: NOT consistent (p 0.004)",
        "yaw 0.5 deg, expected -1 to 1 deg: consistent (p 0.3)",
    ):
        assert part in text
    bare = printed(replace(RUN, band=None))
    assert "coverage" not in bare
    assert "consistent" not in bare


def test_means_over_walks_have_their_intervals():
    runs = tuple(run_of(name, off=off) for name, off in (("a", 0.02), ("b", 0.03)))
    assert "means over" not in printed(*runs)
    summary = tuple(summarise_runs(runs, rng=np.random.default_rng(1)))
    first, (mean, low, high) = summary[0], summary[0].interval
    text = printed(*runs, summary=summary)
    assert f"{first.model}: {first.metric} {mean:.4g} ({low:.4g} to {high:.4g})" in text
    assert "means over 2 walks" in text


def test_errors_of_roll_and_pitch_are_told_with_their_bias(walked):
    angles = walked.orientation[:, :2] + np.radians([1.0, 0.0])
    text = printed(replace(RUN, tilt=judge_tilt(walked, walked.t, angles)))
    for name, bias in (("roll", "-1.00"), ("pitch", "+0.00")):
        assert f"{name}: error against the IMU 0.00 deg rms without bias, bias {bias} deg" in text


def test_what_is_not_known_is_no_number():
    prediction, *baselines = RUN.rows
    coverage = prediction.scores.coverage.copy()
    coverage[:, 2] = np.nan
    unknown = replace(prediction, scores=replace(prediction.scores, coverage=coverage))
    found = [replace(row, errors=replace(row.errors, yaw=float("nan")))
             for row in (unknown, *baselines)]  # fmt: skip
    text = printed(replace(RUN, rows=tuple(found)))
    assert text.count("yaw not testable (of") == len(prediction.scores.levels)
    assert text.count("no heading") == len(found)
    assert "nan" not in text
