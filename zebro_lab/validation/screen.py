# SPDX-License-Identifier: MIT
"""Terminal output of `validate`: errors of walks, or of two trajectories."""

from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from model.metrics.consistency import Consistency
from model.metrics.scores import coverage_range
from zebro_lab.terminal.result import print_result, warnings_first
from zebro_lab.terminal.tables import plain_table
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.validation.stage import Validated
from zebro_lab.validation.trajectory_pair import JudgedPair
from zebro_lab.validation.trajectory_stage import pair_metrics

_STATISTICS = {
    "nees": ("error relative to predicted uncertainty (NEES)", 1.0, ""),
    "along": ("mean error along the path", 1e3, " mm"),
    "cross": ("mean error across the path", 1e3, " mm"),
    "yaw": ("mean error of yaw", 180 / np.pi, " deg"),
}  # meaning, scale and unit of each statistic of the band's consistency


_PAIR = {
    "length_m": "length of the reference",
    "ate_m": "absolute error (ATE), rms",
    "ate_aligned_m": "aligned ATE, rms",
    "alignment_deg": "turn of the alignment",
    "rotation_rms_deg": "error of rotation, rms",
}
"""Names of metrics of two trajectories for people, where their column does not say enough."""


def print_validated(console: Console, validated: Validated | JudgedPair, out: Path) -> None:
    """Print warnings, errors and notes of walks or of two trajectories, and the folder.

    Of walks these are errors, coverage and tilt of each, and the means over several.

    Args:
        console: Console to print to.
        validated: Results of the validation.
        out: Folder that was written.
    """
    parts = _pair(validated) if isinstance(validated, JudgedPair) else _walks(validated)
    print_result(console, parts, source=validated.source, out=out)


def _pair(judged: JudgedPair) -> list[str | Table]:
    """Format warnings, a table of the metrics of two trajectories, and notes.

    Names of metrics come from `_PAIR`, else from the parts of the column, such as `rpe_1m_m`.
    Numbers of pairs are left out, as is the scale if it is 1; NaN is an empty cell.
    """
    warnings, notes = warnings_first(judged.notes)
    table = plain_table(judged.title, ("", "unit"), [row.where for row in judged.rows])
    rows = [pair_metrics(row) for row in judged.rows]
    for key in rows[0]:
        name, unit, values = _PAIR.get(key), "", [row[key] for row in rows]
        if key not in ("poses", "scale"):
            what, _, unit = key.rpartition("_")
            over = what.removeprefix("rpe_")
            of = "consecutive poses" if over == "step" else f"over {over.removesuffix('m')} m"
            relative = f"relative error (RPE), {of}, rms" if over != what else None
            which = "aligned ATE" if "aligned" in what else "ATE"
            name = name or relative or f"{which}, {what.rpartition('_')[2]}"
        if unit == "pairs" or (key == "scale" and all(value == 1 for value in values)):
            continue
        shown = ["" if np.isnan(value) else f"{value:.6g}" for value in values]
        table.add_row(name or key, unit, *shown)
    return [*warnings, table, *notes]


def _walks(validated: Validated) -> list[str | Table]:
    """Format warnings, errors, coverage, tilt and notes of each walk, and means over several."""
    parts: list[str | Table] = []
    for run in validated.runs:
        warnings, notes = warnings_first(run.notes)
        parts += [f"{run.name}: {line}" for line in warnings]
        parts += [_table(run), *_verdict(run), *_tilt(run), *notes]
    for each in validated.summary:
        mean, low, high = each.interval
        parts.append(f"{each.model}: {each.metric} {mean:.4g} ({low:.4g} to {high:.4g})")
    if validated.summary:
        parts.append(f"means over {len(validated.runs)} walks, 90 % intervals over walks")
    return parts


def _table(run: JudgedRun) -> Table:
    """Format the errors of a walk's prediction and baselines as a table.

    ATE, along, across and yaw are root mean squares over the poses; the length is the track's. The
    last row has the radius of the track.
    """
    length = run.rows[0].errors.length
    title = f"{run.name}: {run.rows[0].errors.poses} poses, {length:.3f} m"
    numbers = (
        "ATE\n[mm]", "of path\n[%]", "along\n[mm]", "across\n[mm]", "yaw\n[deg]", "end\n[mm]",
        "aligned\n[mm]", "radius\n[m]", "CRPS x, y\n[mm]",
    )  # fmt: skip
    table = plain_table(title, ("model",), numbers)
    for row in run.rows:
        e = row.errors
        crps = " ".join(f"{1000 * value:.1f}" for value in row.scores.crps[:2])
        table.add_row(
            row.name, f"{1000 * e.ate:.1f}", f"{100 * e.ate_of_length:.2f}",
            f"{1000 * e.along:.1f}",
            f"{1000 * e.cross:.1f}", yaw_text(e.yaw), f"{1000 * e.final_distance:.1f}",
            f"{1000 * e.ate_aligned:.1f}", radius_text(e.radius[0]), crps,
        )  # fmt: skip
    table.add_row("track", *[""] * 7, radius_text(run.rows[0].errors.radius[1]), "")
    return table


def yaw_text(yaw: float) -> str:
    """Format an error of yaw [rad] for a table in degrees: `no heading` if NaN.

    >>> yaw_text(0.1), yaw_text(float("nan"))
    ('5.73', 'no heading')
    """
    return "no heading" if np.isnan(yaw) else f"{np.degrees(yaw):.2f}"


def radius_text(radius: float) -> str:
    """Format a radius [m] for a table: `straight` if infinite, `no circle` if NaN.

    >>> radius_text(1.7012), radius_text(float("inf")), radius_text(float("nan"))
    ('1.701', 'straight', 'no circle')
    """
    if np.isnan(radius):
        return "no circle"
    return "straight" if np.isinf(radius) else f"{radius:.3f}"


def _tilt(run: JudgedRun) -> list[str]:
    """Format the errors of roll and pitch against the IMU [deg]; empty without an IMU."""
    if run.tilt is None:
        return []
    errors = run.tilt.errors
    return [
        f"{name}: error against the IMU {rms:.2f} deg rms without bias, bias {bias:+.2f} deg, "
        f"swing {swing:.2f} deg"
        for name, rms, swing, bias in zip(
            ("roll", "pitch"), np.degrees(errors.rms_unbiased), np.degrees(errors.swing),
            np.degrees(errors.bias), strict=True,
        )
    ]  # fmt: skip


def _verdict(run: JudgedRun) -> list[str]:
    """Format the coverage of the band at each level, and its consistency; empty without a band."""
    row = run.rows[0]
    if run.band is None:
        return []
    states = ("x", "y", "yaw")
    lines = [
        f"coverage of the {level:.0%} band: "
        + ", ".join(
            f"{s} {'not testable' if np.isnan(c) else f'{c:.0%}'}"
            for s, c in zip(states, cover, strict=True)
        )
        + _expected(level, row.errors.poses)
        for level, cover in zip(row.scores.levels, row.scores.coverage, strict=True)
    ]
    return [*lines, *map(_consistency, row.consistency)]


def _expected(level: float, poses: int) -> str:
    """Format the central 95 % range of the coverage of independent poses.

    Errors of poses of one walk are correlated, so that their coverage lies outside more often.
    """
    low, high = coverage_range(level, poses)
    return f" (of {poses} independent poses {low:.0%} to {high:.0%})"


def _consistency(each: Consistency) -> str:
    """Format a statistic of the band's consistency with its expected range and p value."""
    meaning, scale, unit = _STATISTICS[each.name]
    return (
        f"{meaning} {scale * each.value:.3g}{unit}, expected {scale * each.low:.3g} to "
        f"{scale * each.high:.3g}{unit}: {'consistent' if each.consistent else 'NOT consistent'} "
        f"(p {each.p_value:.2g})"
    )
