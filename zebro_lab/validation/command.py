# SPDX-License-Identifier: MIT
"""`zebro-lab validate`: errors of predicted paths against tracked ones."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from zebro_lab.terminal.messages import plain, wide_console
from zebro_lab.terminal.request_command import request_command
from zebro_lab.validation.request import ValidateRequest

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from zebro_lab.validation.judged_run import JudgedRun
    from zebro_lab.validation.stage import Validated

EPILOG = """
Examples:

zebro-lab validate data/20260101T120000Z_walk_tiles

zebro-lab validate --predicted prediction --track track/track.csv --out validation

zebro-lab validate --predicted a/prediction --track a/track --predicted b/prediction --track b/track

zebro-lab validate data/RUN --estimate-offset

Unaligned errors come first: alignment hides a wrong start and a wrong heading. Every path starts
from the first tracked pose, which is not scored.
"""

_STATISTICS = {
    "nees": ("Error relative to predicted uncertainty (NEES)", "", 1.0),
    "along": ("Mean error along the path", " mm", 1e3),
    "cross": ("Mean error across the path", " mm", 1e3),
    "yaw": ("Mean error of heading", " deg", 180 / math.pi),
}
"""Statistics of the band's consistency: words, unit, and factor from SI units."""


@request_command()
def validate(request: ValidateRequest) -> None:
    """Compute the errors of predicted paths against tracked ones, with baselines."""
    from zebro_lab.terminal.progress import progress_bar
    from zebro_lab.validation import stage

    n_predicted, n_tracks = len(request.predicted), len(request.track)
    if n_predicted != n_tracks or not (request.runs or n_predicted):
        raise typer.BadParameter(
            f"{n_predicted} --predicted and {n_tracks} --track; name as many of both, or "
            "run folders"
        )
    if request.estimate_offset and request.time_offset:
        raise typer.BadParameter("give --time-offset, or let --estimate-offset find it; not both")
    with progress_bar() as watcher:
        validated = stage.validate(request, watcher)
    print_validated(wide_console(), validated, request.folder)


def print_validated(console: "Console", validated: "Validated", out: Path) -> None:
    """Print a table for each walk, the means over walks, and the output folder.

    Args:
        console: Console to print to.
        validated: Results of the validation.
        out: Folder that was written.
    """
    from rich.text import Text

    if "sim:" in validated.source:
        console.print(plain(f"SIMULATED: {validated.source}"))
    for run in validated.runs:
        console.print(_table(run))
        for line in (*_verdict(run), *_tilt(run), *run.notes):
            console.print(plain(line))
    for each in validated.summary:
        mean, low, high = each.interval
        console.print(plain(f"{each.model}: {each.metric} {mean:.4g} ({low:.4g} to {high:.4g})"))
    if validated.summary:
        console.print(plain(f"means over {len(validated.runs)} walks, 90 % intervals over walks"))
    console.print(Text(f"\nwritten to {out}"))


def _table(run: "JudgedRun") -> "Table":
    import numpy as np
    from rich import box
    from rich.table import Table

    length = run.rows[0].errors.length
    title = f"{run.name}: {run.rows[0].errors.poses} poses, {length:.3f} m"
    table = Table(title=title, box=box.SIMPLE, title_justify="left")
    table.add_column("model")
    for name in (
        "ATE [mm]", "of path", "along [mm]", "across [mm]", "yaw [deg]", "end [mm]",
        "aligned [mm]", "radius [m]", "CRPS x, y [mm]",
    ):  # fmt: skip
        table.add_column(name, justify="right")
    for row in run.rows:
        e = row.errors
        crps = " ".join(f"{1000 * value:.1f}" for value in row.scores.crps[:2])
        table.add_row(
            row.name, f"{1000 * e.ate:.1f}", f"{e.ate_of_length:.2%}", f"{1000 * e.along:.1f}",
            f"{1000 * e.cross:.1f}", f"{np.degrees(e.yaw):.2f}", f"{1000 * e.final_distance:.1f}",
            f"{1000 * e.ate_aligned:.1f}", f"{e.radius[0]:.3f}", crps,
        )  # fmt: skip
    table.add_row("track", *[""] * 7, f"{run.rows[0].errors.radius[1]:.3f}", "")
    return table


def _tilt(run: "JudgedRun") -> list[str]:
    """Format lines on the errors of roll and pitch against the IMU."""
    import numpy as np

    if run.tilt is None:
        return []
    errors = run.tilt.errors
    return [
        f"{name}: {rms:.2f} deg rms off the IMU's, of a swing of {swing:.2f}; bias {bias:+.2f} deg"
        for name, rms, swing, bias in zip(
            ("roll", "pitch"), np.degrees(errors.rms_unbiased), np.degrees(errors.swing),
            np.degrees(errors.bias), strict=True,
        )
    ]  # fmt: skip


def _verdict(run: "JudgedRun") -> list[str]:
    """Format lines on coverage and consistency (NEES) of the band."""
    row = run.rows[0]
    if run.band is None:
        return []
    states = ("x", "y", "yaw")
    lines = [
        f"the {level:.0%} band holds "
        + ", ".join(f"{c:.0%} of {s}" for s, c in zip(states, cover, strict=True))
        for level, cover in zip(row.scores.levels, row.scores.coverage, strict=True)
    ]
    for each in row.consistency:
        what, unit, scale = _STATISTICS[each.name]
        value, low, high = (scale * x for x in (each.value, each.low, each.high))
        word = "consistent" if each.consistent else "NOT consistent"
        lines.append(
            f"{what} {value:.3g}{unit}, expected {low:.2g} to {high:.2g}{unit}: {word} "
            f"(p = {each.p_value:.2g})."
        )
    return lines
