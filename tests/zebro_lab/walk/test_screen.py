# SPDX-License-Identifier: MIT
"""What is printed of a walk has the numbers of the walk, with units and sides."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import typer
from rich.console import Console

from model.gait import tripod_angles, tripod_reference
from model.walk.support import Support, support_of
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.robot.gait_argument import make_gait
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.terminal.stopping import STOPPED
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.screen import (
    event_table,
    gait_table,
    print_walk,
    run_and_report,
    schedule_line,
    slip_lines,
    summary_lines,
    support_lines,
    tilt_lines,
    walk_document,
)
from zebro_lab.walk.summary import summarise
from zebro_lab.walk.walking import Walked

GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0, direction="left")


def finished(walked, *, slip="coulomb:0.4") -> Walked:
    return Walked(walked, GAIT, RobotFile(), parse_slip(slip), "dynamics", 0.01,
                  "tripod, model 'dynamics'", ("[bold]a note",))  # fmt: skip


def test_the_gait_has_a_row_a_leg_with_angles_times_and_speeds():
    table = gait_table(GAIT)
    assert str(table.title) == "the gait, with a cycle of 2 s"
    columns = [list(column.cells) for column in table.columns]
    assert columns[0] == [
        f"{leg}{' inner' if leg - 1 in GAIT.inner else ' outer'}" for leg in range(1, 7)
    ]
    numbers = np.array(columns[1:], dtype=float).T
    expected = np.column_stack([
        np.degrees(GAIT.touchdown), np.degrees(GAIT.liftoff), GAIT.ground_time, GAIT.flight_time,
        np.degrees(GAIT.ground_speed), np.degrees(GAIT.flight_speed),
        np.degrees(GAIT.angles(0.0)[0]) % 360,
    ])  # fmt: skip
    np.testing.assert_allclose(numbers, expected, atol=1e-4)


def test_a_scheduled_gait_has_its_events_cycle_and_coupling_time(walked, tmp_path):
    request = GaitRequest("{1,4} < {2,5} < {3,6}", tau_double=0.1)
    gait = make_gait(request, leg_arc=np.pi)
    done = replace(finished(walked), reference=gait.reference, schedule=gait.schedule)
    rows = list(zip(*(column.cells for column in event_table(gait.reference).columns), strict=True))
    assert rows == [
        ("1, 4", "", "0.0000"), ("", "2, 5", "0.1000"), ("2, 5", "", "0.9000"),
        ("", "3, 6", "1.0000"), ("3, 6", "", "1.8000"), ("", "1, 4", "1.9000"),
    ]  # fmt: skip
    console = Console(file=io.StringIO(), width=200)
    print_walk(console, done, tmp_path)
    assert "2.7 s; from any start events repeat after 2 cycles" in console.file.getvalue()
    document = walk_document(done)["schedule"]
    assert (document["cycle_time_s"], document["coupling_time_cycles"]) == (pytest.approx(2.7), 2)
    assert document["liftoff_s"].tolist() == [1.9, 0.1, 1.0, 1.9, 0.1, 1.0]
    assert walk_document(finished(walked))["schedule"] is None


def test_a_coupling_time_beyond_what_is_computed_ends_no_walk(walked):
    request = GaitRequest("{1,4} < {2,5} < {3,6}", tau_ground=0.866655, tau_flight=0.33333,
                          tau_turn=0.1)  # fmt: skip
    gait = make_gait(request, leg_arc=np.pi)
    assert gait.schedule is not None
    assert "repeat after more cycles than were tried" in schedule_line(gait.schedule)
    done = replace(finished(walked), reference=gait.reference, schedule=gait.schedule)
    assert walk_document(done)["schedule"]["coupling_time_cycles"] is None


@pytest.mark.parametrize(("sign", "side"), [(1, "left"), (-1, "right")])
def test_the_end_of_the_path_and_its_turn_are_told(walked, sign, side):
    mirrored = replace(
        walked, position=walked.position * [1, sign, 1], orientation=walked.orientation * sign
    )
    first, second, _ = summary_lines(summarise(mirrored))
    x, y = mirrored.position[-1, :2]
    for part in ("after 4 s", f"{x:.4f} m", f"{y:.4f} m", f"{sign * np.degrees(0.6):.2f} deg"):
        assert part in first
    assert f"turning {side}, radius 0.5" in second
    straight = replace(walked, position=walked.position * [1, 0, 1],
                       orientation=0 * walked.orientation)  # fmt: skip
    assert "straight ahead" in summary_lines(summarise(straight))[1]


def test_assumed_slip_and_loads_below_the_tested_are_told(walked):
    mean, assumed = slip_lines(finished(walked), summarise(walked), support_of(walked))
    assert "slip at" in mean
    assert "coulomb:0.4 is assumed" in assumed
    light = replace(walked, normal_force=0.1 * walked.normal_force)
    *_, warning = slip_lines(finished(light, slip="thesis"), summarise(light), support_of(light))
    assert warning.startswith("WARNING: 100% of the contacts carry less than 2.13 N")


@pytest.mark.parametrize(("axis", "degrees"), [(0, 179.0), (1, -89.0)])
def test_a_body_that_overturns_is_warned_of(walked, axis, degrees):
    orientation = walked.orientation.copy()
    orientation[-1, axis] = np.radians(degrees)
    assert tilt_lines(summarise(walked)) == []
    (warning,) = tilt_lines(summarise(replace(walked, orientation=orientation)))
    assert warning.startswith("WARNING: the body overturns")
    assert f"{abs(degrees):.0f}" in warning


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"body": float("nan")}, ()),
        ({"flight": 0.009}, ()),
        ({"flight": 0.226}, ("WARNING: nothing is on the ground", "22.6%")),
        ({"body": 0.001}, ("WARNING: the body touches the ground", "0.1%")),
        ({"unloaded": np.array([0.0, 0.2, 0.04, np.nan, 0.5, 0.0])},
         ("leg 2 in 20%, leg 5 in 50%",)),
    ],
)  # fmt: skip
def test_flight_body_contact_and_idle_legs_are_told(changes, parts):
    quiet = Support(0.0, 0.0, np.full(6, 0.5), np.zeros(6), np.zeros(6))
    lines = support_lines(replace(quiet, **changes))
    assert len(lines) == bool(parts)
    assert all(part in lines[0] for part in parts)


def test_warnings_are_first_notes_last_and_no_markup_and_files_are_listed(walked, tmp_path):
    (tmp_path / "path.csv").touch()
    (tmp_path / "mine.txt").touch()
    doubted = replace(finished(walked), notes=("[bold]log: 3", "WARNING: not trustworthy"))
    console = Console(file=io.StringIO(), width=200)
    print_walk(console, doubted, tmp_path)
    text = console.file.getvalue()
    assert text.startswith("SIMULATED walk: tripod, model 'dynamics', dt 0.01 s")
    assert text.index("WARNING") < text.index("after 4 s") < text.index("[bold]log: 3")
    assert "path.csv" in text
    assert "mine.txt" not in text
    assert walk_document(doubted)["notes"][0] == "WARNING: not trustworthy"


def test_a_stopped_walk_is_one_line_and_exit_130(capsys):
    def stop(_) -> Walked:
        raise WalkStopped("stopped; nothing was written")

    with pytest.raises(typer.Exit) as ended:
        run_and_report("walk", stop, Path("out"))
    assert ended.value.exit_code == STOPPED
    assert capsys.readouterr() == ("", "stopped; nothing was written\n")
