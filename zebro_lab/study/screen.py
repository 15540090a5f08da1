# SPDX-License-Identifier: MIT
"""Terminal output of `study`."""

from pathlib import Path

from rich.console import Console
from rich.table import Table

from model.counted import counted
from model.study.coverage import LEVELS, CoverageResult
from model.study.ranks import RankResult
from zebro_lab.study.stage import Studied
from zebro_lab.terminal.messages import plain
from zebro_lab.terminal.tables import plain_table


def print_study(console: Console, studied: Studied, out: Path) -> None:
    """Print the table of parameters, what was left out, notes, the verdict and the folder.

    Args:
        console: Console to print to.
        studied: The finished study.
        out: Folder that was written.
    """
    console.print(plain(f"SIMULATED experiments: {studied.title}"))
    result = studied.result
    if isinstance(result, RankResult):
        console.print(_rank_table(result))
    else:
        console.print(_coverage_table(result))
    for line in lines(studied):
        console.print(plain(line))
    console.print(plain(f"written to {out}"))


def lines(studied: Studied) -> list[str]:
    """Return notes, what was left out, and the verdict."""
    result = studied.result
    left = result.left_out
    said = list(studied.notes)
    if left:
        failed = sum(bool(each.failure) for each in result.replicates)
        said.append(
            f"{left} of {counted(len(result.replicates), 'fit')} left out: "
            f"{failed} failed, {left - failed} without reliable weights (Pareto k of 0.7 or more, "
            "or too few effective draws); replicates.csv names them"
        )
    else:
        said.append(f"all {counted(len(result.replicates), 'fit')} have reliable weights")
    return [*said, result.headline]


def _rank_table(result: RankResult) -> Table:
    headings = ("chi-square\np", "ECDF\np", "mean rank\n[sd]", "spread\n[sd]")
    limit = result.tests[0].limit if result.tests else 0.0
    title = f"ranks of {counted(result.ranked, 'fit')}; a test fails at p below {limit:.2g}"
    table = plain_table(title, ("parameter", "verdict"), headings, no_wrap=True)
    for each in result.tests:
        table.add_row(
            each.name, each.words, f"{each.chi_square_p:.2g}", f"{each.ecdf_p:.2g}",
            f"{each.mean:+.1f}", f"{each.spread:+.1f}",
        )  # fmt: skip
    return table


def _coverage_table(result: CoverageResult) -> Table:
    counts = [f"{100 * level:g} %\nhold" for level in LEVELS]
    headings = (*counts, "bias\n[sd]", "half width\n[unit]")
    title = f"intervals of {counted(result.counted, 'fit')}"
    if result.covered:
        bands = (
            f"{100 * level:g} %: {low} to {high}"
            for level, (low, high) in zip(LEVELS, result.covered[0].band, strict=True)
        )
        title += f"; 99 % of a count, {', '.join(bands)}"
    table = plain_table(title, ("parameter", "verdict"), headings, no_wrap=True)
    for each in result.covered:
        table.add_row(
            each.name, each.words, *map(str, each.held), f"{each.bias:+.2f}", f"{each.half:.3g}"
        )
    return table
