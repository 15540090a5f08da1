# SPDX-License-Identifier: MIT
import io
import math
from dataclasses import replace

from rich.console import Console

from zebro_lab.adaptive.rounds import Round
from zebro_lab.adaptive.screen import in_numbers, rounds_table, told
from zebro_lab.adaptive.wanted import parse_wanted

WANTED = [parse_wanted("slip_stiffness=0.5"), parse_wanted("force@0.02=0.03"),
          parse_wanted("walk:run")]  # fmt: skip
FIRST = {"slip_stiffness": 1.41, "force@0.02": 0.052, "walk:run": math.nan}
ROUNDS = [
    Round(1, 115.0, 16, 0, FIRST),
    Round(2, 242.0, 62, 1, {**FIRST, "slip_stiffness": 0.51}),
]


def test_a_round_is_told_with_its_intervals_and_what_was_wanted():
    assert told(ROUNDS[0], WANTED) == (
        "round 1: 16 points in 115 s; 90 % intervals: slip_stiffness ± 1.41 (wanted ± 0.5); "
        "force@0.02 ± 5.2 % (wanted ± 3 %); walk:run not known"
    )


def test_a_fit_that_cannot_be_trusted_is_told_with_its_round():
    doubted = replace(ROUNDS[0], doubt="NOT CONVERGED: do not use these numbers")
    assert told(doubted, WANTED).endswith("; the fit: NOT CONVERGED: do not use these numbers")
    assert in_numbers([doubted])[0]["doubt"] == doubted.doubt


def test_the_table_has_a_row_for_each_round_with_the_time_in_all():
    console = Console(file=(out := io.StringIO()), width=120)
    console.print(rounds_table(ROUNDS, WANTED))
    rows = [line.split() for line in out.getvalue().splitlines() if line.strip()[:1].isdigit()]
    assert [row[:4] for row in rows] == [["1", "16", "0", "115"], ["2", "62", "1", "357"]]
    assert "0.51" in rows[1]


def test_a_width_that_is_not_known_is_null_in_a_document():
    assert in_numbers(ROUNDS)[0]["half_widths"]["walk:run"] is None
    assert in_numbers(ROUNDS)[1]["half_widths"]["slip_stiffness"] == 0.51
