# SPDX-License-Identifier: MIT
"""The table of ways is written in SI, a row a way."""

import csv

from zebro_lab.files.result_folder import ResultKind
from zebro_lab.reach.folder import REACH, program_name, write_table


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
