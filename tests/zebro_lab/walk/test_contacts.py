# SPDX-License-Identifier: MIT
"""Contact states of a walk, as found, written, printed and drawn from gait to files by commands."""

import csv
import io
import json
from contextlib import redirect_stdout

import numpy as np
import pytest

from model.frames import attitude
from model.gait import tetrapod_reference, tripod_angles, tripod_reference
from model.gait.reference import SampledReference
from model.robot import Robot
from model.thesis.detected import walk_detected
from model.walk.ground import heights_on
from zebro_lab.ground.ground_file import read_ground
from zebro_lab.main import app
from zebro_lab.terminal import ending
from zebro_lab.walk.contacts import (
    RULES,
    contacts_of,
)
from zebro_lab.walk.folder import CONTACTS, read_walk

TETRAPOD = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
EQ_3_33 = (
    "{2,5,6} → {2,3,6} (0.41 s) → {1,3,4,6} (0.95 s) → {1,4,5} (1.93 s) → {2,4,5} (2.41 s)"
    " → {2,5,6} (2.93 s)"
)


def rows_of(file):
    with file.open(newline="") as text:
        return list(csv.DictReader(text))


def found(reference, *, duration=6.1):
    path = walk_detected(Robot(), reference, duration=duration, dt=0.002)
    return contacts_of(path, reference, by="events")


def test_the_tetrapod_s_cycle_is_that_of_the_thesis():
    assert str(found(TETRAPOD).cycle) == EQ_3_33


def test_the_cycle_of_a_log_is_the_time_its_legs_take_for_a_turn():
    t = np.arange(3051, dtype=float) * 0.002
    log = SampledReference(t, TETRAPOD.angles(t))
    contacts = found(log)
    assert contacts.period == pytest.approx(3.0, abs=0.005)
    assert contacts.cycle is not None
    assert len(contacts.cycle.states) == 5
    assert all(np.isnan(each.asked_t) for each in contacts.touchdowns)


def test_a_log_whose_gait_changes_has_no_cycle():
    tripod = tripod_reference(tripod_angles(np.radians(50.0), 1.0), 1.5)
    t = np.arange(4000, dtype=float) * 0.002
    later = tripod.angles(t - 4.0) + TETRAPOD.angles(4.0) - tripod.angles(0.0)
    theta = np.where(t[:, None] < 4.0, TETRAPOD.angles(t), later)
    contacts = found(SampledReference(t, theta), duration=7.9)
    assert contacts.period is None
    assert contacts.cycle is None


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return the folder of a tetrapod by the thesis's model, and what the command printed."""
    out, printed = tmp_path_factory.mktemp("contacts") / "walk", io.StringIO()
    words = "walk --gait tetrapod --model thesis --duration 6.5 --dt 0.002 --contacts --format svg"
    with redirect_stdout(printed), pytest.raises(SystemExit) as ended:
        ending.run(lambda: app([*words.split(), "--out", str(out)], prog_name="zebro-lab"))
    assert not ended.value.code
    return out, " ".join(printed.getvalue().split())


def test_one_command_prints_eq_3_33_with_its_times_and_writes_tables_and_figure(folder):
    out, printed = folder
    for part in (EQ_3_33, RULES["events"], "a cycle of 3 s, which repeats from 0.41 s on"):
        assert part in printed
    names = {"contacts.csv", "touchdowns.csv", "contacts.svg"}
    assert names < set(CONTACTS)
    manifest = json.loads((out / "manifest.json").read_text())
    assert names <= set(manifest["outputs"])
    assert manifest["settings"]["contact_by"] == "events"


def test_contacts_csv_says_what_path_csv_does(folder):
    out, _ = folder
    path = read_walk(out)
    rows = rows_of(out / "contacts.csv")
    assert float(rows[0]["start"]) == path.t[0]
    assert float(rows[-1]["end"]) == path.t[-1]
    for row in rows:
        assert float(row["duration"]) == pytest.approx(float(row["end"]) - float(row["start"]))
        middle = np.searchsorted(path.t, (float(row["start"]) + float(row["end"])) / 2)
        legs = ",".join(str(leg + 1) for leg in np.flatnonzero(path.contact[middle]))
        assert row["contact"] == "{" + legs + "}"
    assert [row["cycle"] for row in rows] == ["", *"11111", *"22222", "3"]


def test_touchdowns_csv_says_what_path_csv_does(folder):
    out, _ = folder
    path = read_walk(out)
    rows = rows_of(out / "touchdowns.csv")
    assert len(rows) >= 12
    for row in rows:
        leg, k = int(row["leg"]) - 1, int(np.searchsorted(path.t, float(row["t"]) - 1e-6))
        assert path.contact[k, leg]
        assert not path.contact[k - 1, leg]
        angle = path.theta[k, leg] - 2 * np.pi * int(row["turn"])
        assert float(row["angle"]) == pytest.approx(angle, abs=1e-6)
        assert float(row["asked_angle"]) == pytest.approx(np.radians(45.0))
        assert float(row["late"]) == pytest.approx(float(row["t"]) - float(row["asked_t"]))


def test_a_program_and_a_log_have_contacts_too(run_command, tmp_path):
    program = tmp_path / "p.toml"
    program.write_text('[[segment]]\ngait = "tripod"\nuntil = { strides = 1 }\n\n'
                       "[[segment]]\nstand = 0.5\n")  # fmt: skip
    given = ("--slip", "coulomb:0.4", "--contacts", "--json", "--out")
    walk = run_command("walk", program, *given, tmp_path / "w")
    log = run_command("predict", tmp_path / "w", *given, tmp_path / "p")
    for ended, folder in ((walk, "w"), (log, "p")):
        assert ended.code == 0, ended.err
        document = json.loads(ended.out)["contacts"]
        assert [rule["by"] for rule in document["rules"]] == ["force"]
        assert [each["leg"] for each in document["touchdowns"]] == [1, 2, 3, 4, 5, 6]
        assert rows_of(tmp_path / folder / "contacts.csv")[-1]["by"] == "force"


def test_a_program_asks_for_the_touchdowns_of_its_schedule(run_command, tmp_path, monkeypatch):
    shown = []
    monkeypatch.setattr("zebro_lab.walk.pictures.draw_contacts",
                        lambda _folder, _walked, request: shown.append(request.window))  # fmt: skip
    program = tmp_path / "p.toml"
    program.write_text('[[segment]]\ngait = "tripod"\nuntil = { strides = 2 }\n\n'
                       '[[segment]]\ngait = "tripod"\nsteering = -1\n'
                       'until = { strides = 2 }\n')  # fmt: skip
    out = tmp_path / "w"
    assert (
        run_command("walk", program, "--slip", "coulomb:0.4", "--contacts", "--out", out).code == 0
    )
    rows = rows_of(out / "touchdowns.csv")
    assert [(each.begin, each.end) for each in shown] == [(0.0, 8.0)]  # all of it is drawn
    assert [float(row["asked_t"]) for row in rows if row["leg"] == "1"] == [1.0, 3.0, 5.0, 7.0]
    assert [row["turn"] for row in rows if row["leg"] == "1"] == ["1", "2", "2", "1"]  # back again
    for row in rows:
        assert abs(float(row["late"])) < 0.05
        assert float(row["angle"]) == pytest.approx(float(row["asked_angle"]), abs=0.1)


GROUND = """
slope_deg = [3.0, -1.0]
heights = { file = "h.csv", step = 0.02, origin = [-0.3, -0.6] }
"""


@pytest.fixture(scope="module")
def on_ground(tmp_path_factory):
    """Return a walk folder on uneven ground, what the command printed, and the ground."""
    folder, printed = tmp_path_factory.mktemp("ground"), io.StringIO()
    (folder / "ground.toml").write_text(GROUND)
    bumps = 0.005 * np.random.default_rng(4).standard_normal((61, 91))
    np.savetxt(folder / "h.csv", bumps, delimiter=",")
    words = "walk --gait tripod --slip coulomb:0.6 --duration 6 --contacts --window 1:3 --ground"
    with redirect_stdout(printed), pytest.raises(SystemExit) as ended:
        ending.run(lambda: app([*words.split(), str(folder / "ground.toml"), "--out",
                                str(folder / "walk")], prog_name="zebro-lab"))  # fmt: skip
    assert not ended.value.code
    ground = read_ground(folder / "ground.toml").ground
    return folder / "walk", " ".join(printed.getvalue().split()), ground


def over(ground, path, robot, leg, k):
    """Return how high a leg is over the ground at a sample, by many points of its arc [m]."""
    theta, R = path.theta[k, leg], attitude(*path.orientation[k])
    psi = np.linspace(theta - robot.toe_beyond, theta + np.pi, 1001)
    centre = robot.hips[leg] + robot.leg_radius * np.array([np.cos(theta), 0, -np.sin(theta)])
    arc = np.stack([np.cos(psi), 0 * psi, -np.sin(psi)], axis=-1) * robot.leg_radius
    points = (centre + arc) @ R.T + path.position[k]
    return min(z - heights_on(ground, np.array([x]), np.array([y]))[0, 0] for x, y, z in points)


def test_touchdowns_are_where_the_leg_comes_down_to_the_ground(on_ground):
    out, _, ground = on_ground
    path, robot = read_walk(out), Robot()
    rows = [row for row in rows_of(out / "touchdowns.csv") if row["t"]]
    assert len(rows) >= 15
    late = []
    for row in rows:
        leg, k = int(row["leg"]) - 1, int(np.searchsorted(path.t, float(row["t"]) - 1e-6))
        high = [over(ground, path, robot, leg, i) for i in (k + 1, k, k - 1)]
        assert high[0] < 0 < high[2]
        angle = np.interp(0.0, high, path.theta[[k + 1, k, k - 1], leg])
        own = float(row["angle"])
        in_a_step = float(path.theta[k + 1, leg] - path.theta[k, leg])
        assert own == pytest.approx(angle - 2 * np.pi * int(row["turn"]), abs=in_a_step)
        if row["asked_angle"]:  # else it came down twice in a turn without a touchdown asked for
            late.append(own - float(row["asked_angle"]))
    assert np.ptp(late) > np.radians(5.0)  # the ground decides
