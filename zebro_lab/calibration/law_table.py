# SPDX-License-Identifier: MIT
"""What `--law compare` found, as a sentence, a CSV table and content of `slip.toml`."""

import csv
import io
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from model.counted import counted

if TYPE_CHECKING:  # takes long to import, and the folder's reader needs none of it
    from model.bayes.law_scores import Difference, LawScores

LAWS_CSV: Final = "laws.csv"
COLUMNS: Final[tuple[str, ...]] = (
    "law", "parameters", "told_together", "fitted",
    "log_density_runs", "difference_runs", "error_runs", "largest_k_runs", "refitted_runs",
    "log_density_loads", "difference_loads", "error_loads", "largest_k_loads", "refitted_loads",
    "unreliable",
)  # fmt: skip


def sentence(scores: "LawScores") -> str:
    """Say which law is fitted, and why, in a sentence or two.

    Args:
        scores: The comparison.
    """
    chosen = scores.laws[scores.chosen].name
    others = [i for i in scores.told_together if i != scores.chosen]
    if others:
        names = ", ".join(
            f"'{scores.laws[i].name}' ({signed(scores.runs(i, scores.chosen))})" for i in others
        )
        fewest = len(scores.laws[scores.chosen].law.parameters)
        alone = all(len(scores.laws[i].law.parameters) > fewest for i in others)
        why = "the simplest" if alone else "of as many parameters the first"
        said = f"'{chosen}' and {names} cannot be told apart by these data; {why}, '{chosen}', "
        said += "is fitted"
    else:
        said = f"'{chosen}' predicts what was left out best and is fitted"
    worse = [i for i in range(len(scores.laws)) if i not in scores.told_together]
    if worse:
        listed = ", ".join(f"'{scores.laws[i].name}' {_loss(scores, i)}" for i in worse)
        said += f"; clearly worse: {listed}"
    return f"{said}. {_caveats(scores)}".rstrip()


def _loss(scores: "LawScores", index: int) -> str:
    """Say by how much a law predicts worse than the fitted one.

    It is told of left-out runs, if the law is clearly worse there or there is one load; else of
    left-out loads.
    """
    runs, loads = scores.runs(index, scores.chosen), scores.loads(index, scores.chosen)
    if runs.clearly_worse or loads is None:
        return f"({signed(runs)})"
    return f"({signed(loads)} on left-out loads)"


def _caveats(scores: "LawScores") -> str:
    """Say what was not testable or is not reliable; empty if nothing was."""
    said = []
    if len(scores.levels) < 2:
        said.append(
            "Predictions of left-out loads are not testable with these data (one load): which law "
            "holds at other loads is unknown."
        )
    doubtful = [scores.laws[i] for i in scores.told_together if scores.laws[i].unreliable]
    said += [
        f"Of '{law.name}' {counted(law.unreliable, 'prediction')} of left-out runs or loads "
        "are not reliable (k-hat over 0.7 also without them)."
        for law in doubtful
    ]
    return " ".join(said)


def signed(difference: "Difference") -> str:
    """Format a difference of log predictive densities with its sign and standard error.

    >>> from model.bayes.law_scores import Difference
    >>> signed(Difference(-12.34, 4.5))
    '-12.3 ± 4.5'
    """
    return f"{difference.value:+.1f} ± {difference.error:.1f}"


def laws_csv(scores: "LawScores") -> str:
    """Format the comparison as CSV: a header `COLUMNS`, then one line a law, the simplest first."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(COLUMNS)
    table.writerows(row.values() for row in _rows(scores))
    return text.getvalue()


def laws_content(scores: "LawScores") -> dict[str, Any]:
    """Return the comparison for `slip.toml`: keys `sentence`, `loads` [N] and `laws`.

    The laws have the keys of `laws.csv`, without those of loads where there is one load.
    """
    rows = [{key: each for key, each in row.items() if each != ""} for row in _rows(scores)]
    loads = [float(load) for load in scores.levels]
    return {"sentence": sentence(scores), "loads": loads, "laws": rows}


def _rows(scores: "LawScores") -> list[dict[str, Any]]:
    """Return one row a law; the values of loads are empty where there is one load."""
    rows = []
    for index, score in enumerate(scores.laws):
        row: dict[str, Any] = dict.fromkeys(COLUMNS, "")
        row |= {
            "law": score.name,
            "parameters": len(score.law.parameters),
            "told_together": index in scores.told_together,
            "fitted": index == scores.chosen,
            "unreliable": score.unreliable,
        }
        parts = (
            ("runs", score.runs, scores.runs(index, scores.chosen)),
            ("loads", score.loads, scores.loads(index, scores.chosen)),
        )
        for what, left_out, difference in parts:
            if left_out is not None and difference is not None:
                row |= {
                    f"log_density_{what}": _rounded(left_out.log_density.sum()),
                    f"difference_{what}": _rounded(difference.value),
                    f"error_{what}": _rounded(difference.error),
                    f"largest_k_{what}": _rounded(left_out.pareto_k.max()),
                    f"refitted_{what}": int(np.sum(left_out.refitted)),
                }
        rows.append(row)
    return rows


def _rounded(value: float) -> float:
    """Round a number to three decimals."""
    return round(float(value), 3)
