# SPDX-License-Identifier: MIT
"""The table of ways is written in SI, a row a way; a program is read back as the same cycles."""

import csv

import numpy as np
import pytest

from model.routes.manoeuvre import Part
from zebro_lab.files.result_folder import ResultKind
from zebro_lab.reach.folder import REACH, program_name, program_text, write_table
from zebro_lab.reach.request import SteppingRequest
from zebro_lab.reach.stage import stepping_of
from zebro_lab.walk.program_file import read_program


class WayStub:
    """A way with a document of its own."""

    number = 2

    class goal:  # noqa: N801 stands for the attribute
        x, y, heading = 1.0, -0.5, None

    @staticmethod
    def document():
        return {"manoeuvre": "curve", "parts": "1 stride, 2 strides", "time_s": 12.5,
                "heading_error_rad": float("nan")}  # fmt: skip


def test_a_row_has_the_goal_then_the_way_and_empty_cells_for_what_is_not_asked(tmp_path):
    file = tmp_path / "reach.csv"
    write_table(file, [WayStub(), WayStub()])
    with file.open(newline="") as text:
        rows = list(csv.DictReader(text))
    assert len(rows) == 2
    assert rows[0] == {
        "goal": "2", "x_m": "1", "y_m": "-0.5", "heading_rad": "", "manoeuvre": "curve",
        "parts": "1 stride, 2 strides", "time_s": "12.5", "heading_error_rad": "",
    }  # fmt: skip


def test_programs_of_several_goals_have_their_number():
    assert isinstance(REACH, ResultKind)
    names = {program_name(n, "curve", goals=2) for n in (1, 2)}
    assert names == {"goal1-curve.toml", "goal2-curve.toml"}
    assert program_name(1, "curve", goals=1) == "curve.toml"


PARTS = (Part(-1.0, 0.31, 1), Part(0.0, 1.0, 7), Part(0.2, 0.9, 2))
REQUESTS = {
    "tripod": SteppingRequest(),
    "slow": SteppingRequest(cycle=4.0),
    "times": SteppingRequest(tau_ground=1.2, tau_flight=0.8, tau_double=0.1),
    "tetrapod": SteppingRequest(gait="tetrapod", liftoff_deg=130.0, touchdown_deg=45.0),
    "groups": SteppingRequest(gait="{1,4} < {2,5} < {3,6}", cycle=3.0),
}


@pytest.mark.parametrize("name", REQUESTS)
@pytest.mark.parametrize("arc_deg", [180, 200])
def test_the_program_has_the_cycles_of_the_parts(name, arc_deg, tmp_path):
    arc = float(np.radians(arc_deg))
    stepping = stepping_of(REQUESTS[name], arc)
    file = tmp_path / "program.toml"
    file.write_text(program_text(PARTS, stepping, REQUESTS[name], about=["a comment"]))
    program = read_program(file, leg_arc=arc)
    for part, segment in zip(PARTS, program.segments, strict=True):
        asked, found = stepping.cycle(part), segment.gait
        np.testing.assert_allclose(found.touchdown, asked.touchdown, atol=1e-6)
        np.testing.assert_allclose(found.liftoff, asked.liftoff, atol=1e-6)
        np.testing.assert_array_equal(found.sense, asked.sense)
        np.testing.assert_allclose(
            found.system.steady_state.touchdown, asked.system.steady_state.touchdown
        )
        assert segment.until.strides == part.strides


def test_a_comment_says_what_the_program_is():
    text = program_text(PARTS, stepping_of(SteppingRequest(), np.pi), SteppingRequest(),
                        about=["curve to 1, 0 m", "zebro-lab walk curve.toml"])  # fmt: skip
    assert text.splitlines()[:2] == ["# curve to 1, 0 m", "# zebro-lab walk curve.toml"]
