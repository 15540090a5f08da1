# SPDX-License-Identifier: MIT
"""Terminal output of `walk` and `predict`: summary of the path, slip and gait."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from model.arrays import Array
from model.counted import counted
from model.errors import DomainError
from model.gait import CyclicReference, EventSystem
from model.tasks import Watcher
from model.walk.leg_work import LegWork, leg_work
from model.walk.support import SLIDES, Support, support_of
from zebro_lab.files.result_folder import MANIFEST
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.result import print_result, warnings_first
from zebro_lab.terminal.tables import plain_table
from zebro_lab.walk.contact_screen import contact_document, contact_lines, touchdown_table
from zebro_lab.walk.folder import FILES
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.summary import WalkSummary, segment_summaries, segment_table, summarise
from zebro_lab.walk.walking import Walked

_STEEP = 30.0  # deg; a body that stands on its legs sways by a few degrees
_MUCH_FLIGHT = 0.01  # share of the time; a few steps between two stances do not matter
_MUCH_UNLOADED = 0.05  # share of a stance; touchdown and lift-off are never quite at its ends
_MANY_UNTESTED = 0.01  # share of the contacts; a few at touchdown do not matter


def run_and_report(
    command: str, run: Callable[[Watcher], Walked], folder: Path, output: Output = TEXT
) -> None:
    """Run a stage with a progress bar and print the results.

    Args:
        command: Name of the command.
        run: The stage; given a watcher, it writes the folder and returns the walk.
        folder: Walk folder that the stage writes.
        output: What is printed.

    Raises:
        Exit: The walk was stopped (exit code 130); other errors of the stage pass.
    """
    with output.progress(WalkStopped) as watcher:
        walked = run(watcher)
    print_walk(output.console(), walked, folder)
    output.document(command, {**walk_document(walked), "folder": folder})


def walk_document(walked: Walked) -> dict[str, object]:
    """Return the results of a walk for `--json`; keys end in the unit."""
    summary, support, work = _summary(walked), _support(walked), leg_work(walked.path)
    x, y, yaw = summary.end
    return {
        "title": walked.title,
        "simulated": True,
        "time_step_s": walked.dt,
        "duration_s": summary.duration,
        "end_x_m": x,
        "end_y_m": y,
        "end_yaw_rad": yaw,
        "length_m": summary.length,
        "strides": summary.strides,
        "speed_m_per_s": summary.speed,
        "yaw_rate_rad_per_s": summary.yaw_rate,
        "radius_m": summary.radius,
        "largest_roll_rad": summary.largest_roll,
        "largest_pitch_rad": summary.largest_pitch,
        "mean_slip_m_per_s": summary.mean_slip,
        "work_done_j": work.done,
        "work_taken_back_j": work.taken_back,
        "slip_energy_j": work.slip,
        "contact_energy_j": work.contacts,
        "flight_share": support.flight,
        "body_contact_share": support.body,
        "loaded_shares": support.loaded,
        "sliding_shares": support.sliding,
        "unloaded_shares": support.unloaded,
        "schedule": _schedule_document(walked),
        "contacts": None if walked.contacts is None else contact_document(walked.contacts),
        "segments": [each.document() for each in segment_summaries(walked.path, walked.segments)],
        "notes": _notes(walked, summary),
    }


def _schedule_document(walked: Walked) -> dict[str, object] | None:
    """Return cycle, coupling time and events of a max-plus gait for `--json`; None for others."""
    if walked.schedule is None or not isinstance(walked.reference, CyclicReference):
        return None
    down, up = _events(walked.reference)
    return {
        "gait": str(walked.schedule.gait),
        "cycle_time_s": walked.schedule.cycle_time,
        "coupling_time_cycles": _coupling_time(walked.schedule),
        "touchdown_s": down,
        "liftoff_s": up,
    }


def print_walk(console: Console, walked: Walked, out: Path) -> None:
    """Print title, gait, warnings, summary, slip and notes of a walk, and the files written.

    Args:
        console: Console to print to.
        walked: The finished walk; the table is printed only for a cyclic gait.
        out: The walk folder, of which the files that the commands write are listed.
    """
    parts: list[str | Table] = [f"SIMULATED walk: {walked.title}, dt {walked.dt:g} s"]
    if isinstance(walked.reference, CyclicReference):
        parts.append(gait_table(walked.reference))
        if walked.schedule is not None:
            parts += [event_table(walked.reference), schedule_line(walked.schedule)]
    if walked.segments:
        parts.append(segment_table(segment_summaries(walked.path, walked.segments)))
    summary = _summary(walked)
    warnings, notes = warnings_first(_notes(walked, summary))
    parts += [*warnings, *summary_lines(summary), *notes]
    if walked.contacts is not None:
        parts += [*contact_lines(walked.contacts), touchdown_table(walked.contacts)]
    files = [path for path in sorted(out.iterdir()) if path.name in (*FILES, MANIFEST)]
    print_result(console, parts, out=out, files=files)


def _notes(walked: Walked, summary: WalkSummary) -> list[str]:
    """Return all notes on a walk, warnings first: on its tilt, support, slip and work too."""
    support = _support(walked)
    lines = [*walked.notes, *tilt_lines(summary), *support_lines(support)]
    lines += [*slip_lines(walked, summary, support), *work_lines(leg_work(walked.path))]
    warnings, notes = warnings_first(lines)
    return [*warnings, *notes]


def _summary(walked: Walked) -> WalkSummary:
    """Summarise a walk; one of a program has several gaits, hence no mean speed or radius."""
    return summarise(walked.path, one_gait=not walked.segments)


def _support(walked: Walked) -> Support:
    """Compute shares of support; stances are those of a gait, else those of a program, if any."""
    path, reference, stances = walked.path, walked.reference, walked.stances
    if isinstance(reference, CyclicReference):
        stances = reference.stance_intervals((float(path.t[0]), float(path.t[-1])))
    return support_of(path, stances)


def support_lines(support: Support) -> list[str]:
    """Say how much of the time the robot flew, its body touched, and legs stood without load.

    Flight above 1 % of the time and any contact of the body are warnings; legs that are unloaded in
    more than 5 % of their stance are named.
    """
    lines = []
    if support.flight > _MUCH_FLIGHT:
        lines.append(f"WARNING: nothing is on the ground in {support.flight:.1%} of the time: "
                     "all legs are lifted at once, and the robot falls; check the gait's "
                     "times")  # fmt: skip
    if support.body > 0:
        lines.append(f"WARNING: the body touches the ground in {support.body:.1%} of the time; "
                     "its friction is that of the legs, which nothing has measured")  # fmt: skip
    idle = [f"leg {leg} in {share:.0%}" for leg, share in enumerate(support.unloaded, start=1)
            if share > _MUCH_UNLOADED]  # fmt: skip
    if idle:
        lines.append(f"legs without load in their stance: {', '.join(idle)} of it")
    return lines


def tilt_lines(summary: WalkSummary) -> list[str]:
    """Return a warning if the body tilts by over `_STEEP`, as none does on its legs; else empty."""
    roll, pitch = np.degrees([summary.largest_roll, summary.largest_pitch])
    if max(roll, pitch) <= _STEEP:
        return []
    return [
        f"WARNING: the body overturns, with a roll of {roll:.0f} and a pitch of {pitch:.0f} "
        f"deg; the model holds for a body on its legs, up to about {_STEEP:g} deg: check the robot "
        "and the leg angles, and do not use this path"
    ]


def summary_lines(summary: WalkSummary) -> list[str]:
    """Format three lines: end pose; length, speed and radius; largest roll and pitch.

    Of a walk of several gaits, speed and radius are left out.
    """
    x, y, yaw = summary.end
    over = f"over {summary.strides} strides" if summary.strides else "over the whole walk"
    rate = f"yaw rate {np.degrees(summary.yaw_rate):.3f} deg/s"
    if summary.straight:
        curve = f"straight ahead, {rate}"
    elif np.isnan(summary.radius):
        curve = f"on no circle, so without a radius, {rate}"
    else:
        side = "left" if summary.radius > 0 else "right"
        curve = f"turning {side}, radius {abs(summary.radius):.4f} m, {rate}"
    return [
        f"after {summary.duration:g} s at x {x:.4f} m, y {y:.4f} m, yaw {np.degrees(yaw):.2f} deg",
        f"walked {summary.length:.4f} m"
        + (
            ""
            if np.isnan(summary.speed)
            else f" at {1000 * summary.speed:.2f} mm/s; {curve} ({over})"
        ),
        f"largest roll {np.degrees(summary.largest_roll):.2f} deg, "
        f"pitch {np.degrees(summary.largest_pitch):.2f} deg",
    ]


def slip_lines(walked: Walked, summary: WalkSummary, support: Support) -> list[str]:
    """Format mean slip speed and sliding, if known, and a warning on untested contacts.

    Untested are contacts with a load below the least tested one; up to 1 % of them give no warning.

    Args:
        walked: The walk with its slip law; a law without tested loads is noted as assumed.
        summary: Summary of the walk.
        support: How much of its contact each leg slides.
    """
    lines = []
    if np.isfinite(summary.mean_slip):
        most = float(np.nanmax(support.sliding))
        lines.append(
            f"legs in contact slip at {1000 * summary.mean_slip:.2f} mm/s on average; leg "
            f"{int(np.nanargmax(support.sliding)) + 1} most, over {1000 * SLIDES:g} mm/s in "
            f"{most:.0%} of its contact"
        )
    if walked.slip is None:
        return lines
    untested, tested = walked.slip.loads_below_tested(walked.path), walked.slip.tested_loads
    if untested is None or tested is None:
        lines.append(f"slip: {walked.slip.text} is assumed, not measured")
    elif untested > _MANY_UNTESTED:
        lines.append(
            f"WARNING: {untested:.0%} of the contacts carry less than {tested[0]:.3g} N, the "
            "lowest load the slip law was tested at"
        )
    return lines


def work_lines(work: LegWork) -> list[str]:
    """Say what work the legs' motors do and take back; empty if the model computes no work."""
    if np.isnan(work.done):
        return []
    return [
        f"motors of the legs do {work.done:.3g} J and take back {work.taken_back:.3g} J; slip "
        f"takes {work.slip:.3g} J, contacts {work.contacts:.3g} J"
    ]


def schedule_line(schedule: EventSystem) -> str:
    """Say what the max-plus system of a gait computed: cycle time and coupling time."""
    cycles = _coupling_time(schedule)
    after = "more cycles than were tried" if cycles is None else counted(cycles, "cycle")
    return (
        f"scheduled by max-plus algebra, {schedule.gait}: cycle time (eigenvalue) "
        f"{schedule.cycle_time:.4g} s; from any start events repeat after {after} (coupling time)"
    )


def _coupling_time(schedule: EventSystem) -> int | None:
    """Return the coupling time in cycles; None if it is longer than is computed."""
    try:
        return schedule.coupling_time
    except DomainError:
        return None


def gait_table(reference: CyclicReference) -> Table:
    """Return a table of a gait, a row per leg: angles [deg], times [s] and speeds [deg/s]."""
    title = f"the gait, with a cycle of {reference.period:.4g} s"
    numbers = (
        "touchdown\n[deg]", "lift-off\n[deg]", "ground\n[s]", "flight\n[s]", "ground\n[deg/s]",
        "flight\n[deg/s]", "at t = 0\n[deg]",
    )  # fmt: skip
    table = plain_table(title, ("leg",), numbers)
    start = np.degrees(reference.angles(0.0)[0]) % 360
    columns = (
        np.degrees(reference.touchdown), np.degrees(reference.liftoff), reference.ground_time,
        reference.flight_time, np.degrees(reference.ground_speed),
        np.degrees(reference.flight_speed), start,
    )  # fmt: skip
    for leg in range(reference.n_legs):
        side = " inner" if leg in reference.inner else " outer" if reference.inner else ""
        table.add_row(f"{leg + 1}{side}", *(f"{column[leg]:.4f}" for column in columns))
    return table


def event_table(reference: CyclicReference) -> Table:
    """Return a table of a gait's events: legs that touch down and lift off, by time [s]."""
    down, up = _events(reference)
    table = plain_table("events of a cycle", ("legs down", "legs up"), ("time\n[s]",))
    for t in np.unique([down, up]):
        legs = (", ".join(map(str, np.flatnonzero(each == t) + 1)) for each in (down, up))
        table.add_row(*legs, f"{t:.4f}")
    return table


def _events(reference: CyclicReference) -> tuple[Array, Array]:
    """Return each leg's touchdown and lift-off from 0 to below a period, shape (n,) each [s]."""
    period = round(reference.period, 9)
    down = -reference.phase * period
    down, up = (np.round(each, 9) % period for each in (down, down + reference.ground_time))
    return np.round(down, 9), np.round(up, 9)
