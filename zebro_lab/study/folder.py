# SPDX-License-Identifier: MIT
"""The result folders of `study`: tables of parameters and of replicates, pictures, verdict."""

import csv
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from model.study.coverage import LEVELS, CoverageReplicate, CoverageResult, Covered
from model.study.design import StudyDesign
from model.study.ranks import RankReplicate, RankResult, Uniformity
from zebro_lab.files.picture_format import PictureFormat, in_every_format
from zebro_lab.files.result_folder import ResultKind

PARAMETERS: Final = "parameters.csv"
REPLICATES: Final = "replicates.csv"
RANKS, ECDF, INTERVALS = "ranks", "ecdf", "coverage"
SBC: Final = ResultKind(
    "study-sbc", "study sbc", (PARAMETERS, REPLICATES, *in_every_format(RANKS, ECDF))
)
COVERAGE: Final = ResultKind(
    "study-coverage", "study coverage", (PARAMETERS, REPLICATES, *in_every_format(INTERVALS))
)


def write_ranks(
    folder: Path, result: RankResult, fitted: StudyDesign, *, title: str, form: PictureFormat
) -> None:
    """Write tables and pictures of a study of ranks.

    Args:
        folder: Existing folder to write into.
        result: The finished study.
        fitted: Design of the fit, for names and units of its parameters.
        title: What was simulated and fitted.
        form: Format of the pictures.
    """
    from zebro_lab.plots import save
    from zebro_lab.study.pictures import draw_ecdf, draw_ranks

    _write_table(folder / PARAMETERS, [rank_row(each) for each in result.tests])
    _write_table(folder / REPLICATES, [_rank_replicate_row(each) for each in result.replicates])
    if result.tests:
        save(draw_ranks(result.tests, title=title), folder / f"{RANKS}.{form}")
        save(draw_ecdf(result.tests, title=title), folder / f"{ECDF}.{form}")


def write_coverage(
    folder: Path, result: CoverageResult, design: StudyDesign, *, title: str, form: PictureFormat
) -> None:
    """Write tables and picture of a study of coverage.

    Args:
        folder: Existing folder to write into.
        result: The finished study.
        design: Design of the fit, for the units of its parameters.
        title: What was simulated and fitted.
        form: Format of the picture.
    """
    from zebro_lab.plots import save
    from zebro_lab.study.pictures import draw_coverage

    units = units_of(design)
    rows = [coverage_row(each, units[each.name]) for each in result.covered]
    _write_table(folder / PARAMETERS, rows)
    replicates = [_coverage_replicate_row(each) for each in result.replicates]
    _write_table(folder / REPLICATES, replicates)
    if result.covered:
        save(draw_coverage(result.covered, title=title), folder / f"{INTERVALS}.{form}")


def units_of(design: StudyDesign) -> dict[str, str]:
    """Return the unit of each parameter by name, as pint spells it."""
    return {p.name: p.unit for p in design.posterior(design.blocks).parameters}


def ranks_content(result: RankResult) -> dict[str, object]:
    """Return the verdict of a study of ranks, for manifest and document."""
    return {
        "verdict": _verdict(result.headline, bool(result.failed), testable=result.testable),
        "ranked": result.ranked,
        "left_out": result.left_out,
        "largest_pareto_k": _largest_k(result.replicates),
        "parameters": [rank_row(each) for each in result.tests],
    }


def coverage_content(result: CoverageResult, design: StudyDesign) -> dict[str, object]:
    """Return the verdict of a study of coverage, for manifest and document."""
    units = units_of(design)
    return {
        "verdict": _verdict(result.headline, bool(result.failed), testable=result.testable),
        "counted": result.counted,
        "left_out": result.left_out,
        "largest_pareto_k": _largest_k(result.replicates),
        "parameters": [coverage_row(each, units[each.name]) for each in result.covered],
    }


def _verdict(headline: str, failed: bool, *, testable: bool) -> dict[str, str]:
    outcome = "failed" if failed else "passed" if testable else "not_testable"
    return {"outcome": outcome, "headline": headline}


def _largest_k(replicates: Sequence[RankReplicate] | Sequence[CoverageReplicate]) -> float | None:
    """Return the largest tail index among the fits that count; None if there are none."""
    return max((each.pareto_k for each in replicates if each.reliable), default=None)


def rank_row(test: Uniformity) -> dict[str, Any]:
    """Return the test of one parameter's ranks as a row."""
    return {
        "parameter": test.name,
        "verdict": test.words,
        "chi_square_p": test.chi_square_p,
        "ecdf_p": test.ecdf_p,
        "limit": test.limit,
        "mean_rank_in_sd": test.mean,
        "spread_of_ranks_in_sd": test.spread,
    }


def coverage_row(covered: Covered, unit: str) -> dict[str, Any]:
    """Return the coverage of one parameter as a row."""
    row: dict[str, Any] = {
        "parameter": covered.name,
        "unit": unit,
        "verdict": covered.words,
        "truth": covered.truth,
        "intervals": covered.n,
    }
    for level, held, band, joint in zip(
        LEVELS, covered.held, covered.band, covered.joint, strict=True
    ):
        name = f"{100 * level:g}"
        row |= {f"held_{name}": held, f"band_{name}_low": band[0], f"band_{name}_high": band[1],
                f"joint_{name}_low": joint[0], f"joint_{name}_high": joint[1]}  # fmt: skip
    return {**row, "bias_in_sd": covered.bias, "half_width": covered.half}


def _rank_replicate_row(each: RankReplicate) -> dict[str, Any]:
    return {
        **_fit_row(each),
        **{f"true_{name}": value for name, value in each.truth.items()},
        **{f"rank_{name}": rank for name, rank in each.ranks.items()},
    }


def _coverage_replicate_row(each: CoverageReplicate) -> dict[str, Any]:
    levels = [f"{100 * level:g}" for level in LEVELS]
    return {
        **_fit_row(each),
        **{f"true_{name}": value for name, value in each.truth.items()},
        **{
            f"held_{level}_{name}": int(inside)
            for name, held in each.held.items()
            for level, inside in zip(levels, held, strict=True)
        },
        **{f"error_in_sd_{name}": score for name, score in each.score.items()},
        **{f"half_width_{name}": half for name, half in each.half.items()},
    }


def _fit_row(each: RankReplicate | CoverageReplicate) -> dict[str, Any]:
    return {
        "replicate": each.index,
        "reliable": int(each.reliable),
        "pareto_k": each.pareto_k,
        "effective_draws": each.effective,
        "failure": each.failure,
    }


def _write_table(file: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write rows as CSV with the columns of all of them; an empty cell where a row has none."""
    names = dict.fromkeys(name for row in rows for name in row)
    with file.open("w", encoding="utf-8", newline="") as text:
        writer = csv.DictWriter(text, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)


def _cell(value: object) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return f"{value:.8g}" if isinstance(value, float) else str(value)
