# SPDX-License-Identifier: MIT
"""What is told of a comparison of laws: the reason of the choice, and every figure behind it."""

import csv
import io
import json
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from model.bayes.law_scores import LawScore, LawScores, choose_law
from model.bayes.left_out import LeftOut
from model.slip import Brush, MagicFormula
from support.drawn_figures import figures_saved
from support.short_calibration import short_calibration
from zebro_lab.calibration.folder import read_slip_file, write_tables
from zebro_lab.calibration.law_table import laws_content, laws_csv, sentence
from zebro_lab.calibration.pictures import draw_calibration
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.screen import print_calibration
from zebro_lab.files.documents import read_toml_document

NOISE = np.array([-1.5, 1.5] * 6)
FORMULA, BRUSH = MagicFormula("constant"), Brush()


def left_out(log_density, group, k=0.3) -> LeftOut:
    n = int(group.max()) + 1
    return LeftOut(group, np.asarray(log_density, float), np.full(n, k), np.ones(n, dtype=bool))


def score(name, law, values, worse, *, k=0.3, loads=True) -> LawScore:
    runs = left_out(NOISE * worse - worse, np.arange(12), k)
    of_loads = left_out(NOISE - 3 * worse, np.arange(12) // 6) if loads else None
    return LawScore(name, law, runs, of_loads, np.tile(values, (20, 1)))


def scores(worse, levels=(4.0, 12.0), **options) -> LawScores:
    loads = len(levels) > 1
    return choose_law(
        [
            score("magic-formula, one E", FORMULA, (20.0, 1.5, 0.4, 0.0), 0.0, loads=loads),
            score("brush", BRUSH, (20.0, 0.4), worse, loads=loads, **options),
        ],
        np.array(levels),
    )


@pytest.fixture(scope="module")
def compared():
    return replace(short_calibration(), comparison=scores(3.0))


def test_a_clear_difference_is_told_with_its_error():
    said = sentence(scores(3.0))
    assert "'magic-formula, one E' predicts what was left out best and is fitted" in said
    assert "clearly worse: 'brush' (-36.0 ± 16.3)." in said


def test_laws_that_cannot_be_told_apart_are_named_and_the_simplest_fitted():
    said = sentence(scores(0.1))
    assert "'brush' and 'magic-formula, one E' (+1.2 ± 0.5) cannot be told apart" in said
    assert "the simplest, 'brush', is fitted" in said


def test_of_laws_with_as_many_parameters_the_first_is_not_called_simplest():
    twin = [score(name, BRUSH, (20.0, 0.4), 0.0) for name in ("one", "two")]
    assert "of as many parameters the first, 'one', is fitted" in sentence(
        choose_law(twin, np.array([4.0, 12.0]))
    )


def test_one_load_and_bad_weights_are_said():
    said = sentence(scores(0.1, levels=(8.0,), k=0.9))
    assert "left-out loads are not testable with these data (one load)" in said
    assert "Of 'brush' 12 predictions of left-out runs or loads are not reliable" in said


def test_the_table_has_every_law_and_leaves_loads_empty_at_one():
    rows = list(csv.DictReader(io.StringIO(laws_csv(scores(3.0, levels=(8.0,))))))
    assert [row["law"] for row in rows] == ["brush", "magic-formula, one E"]
    assert [row["fitted"] for row in rows] == ["False", "True"]
    assert (float(rows[0]["difference_runs"]), rows[0]["difference_loads"]) == (-36.0, "")
    assert "difference_loads" not in laws_content(scores(3.0, levels=(8.0,)))["laws"][0]


def test_folder_screen_and_picture_show_the_comparison(compared, tmp_path, monkeypatch):
    write_tables(tmp_path, compared, inputs={})
    written = read_toml_document(tmp_path / "slip.toml", remedy="")
    assert written["comparison"]["sentence"] == sentence(compared.comparison)
    assert [law["law"] for law in written["comparison"]["laws"]] == [
        "brush",
        "magic-formula, one E",
    ]
    assert read_slip_file(tmp_path).curve.law == compared.posterior.law
    assert (tmp_path / "laws.csv").read_text() == laws_csv(compared.comparison)
    console = Console(file=io.StringIO(), width=120)
    print_calibration(console, compared, tmp_path)
    (row,) = [line for line in console.file.getvalue().splitlines() if "clearly worse  " in line]
    assert row.split()[:7] == ["brush", "clearly", "worse", "2", "-36.0", "±", "16.3"]
    saved = figures_saved(monkeypatch)
    draw_calibration(tmp_path, compared, CalibrationRequest())
    assert saved["laws.png"].get_suptitle().startswith("Slip laws compared (simulated)")


@pytest.mark.long
def test_the_command_compares_fits_and_reports_in_json(sweep, run_command, tmp_path):
    out = tmp_path / "calibration"
    ended = run_command(
        "calibrate-slip", sweep, "--law", "compare", "--out", out, "--max-steps", 500, "--json"
    )
    assert ended.code in (0, 3)
    comparison = json.loads(ended.out)["calibration"]["comparison"]
    fitted = [law["law"] for law in comparison["laws"] if law["fitted"]]
    assert fitted == ["magic-formula, peak by load"]  # the truth of these data
    assert (out / "laws.png").exists()
