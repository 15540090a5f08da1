# SPDX-License-Identifier: MIT
"""Results begin with what is simulated and end with the folder; warnings come first."""

from pathlib import Path

from rich.console import Console

from zebro_lab.terminal.result import print_result, warnings_first


def test_what_is_simulated_is_said_first_and_the_folder_last():
    console = Console(record=True, width=80, quiet=False)
    print_result(console, ["a [mm]"], source="sim:walk", out=Path("out"))
    lines = console.export_text().splitlines()
    assert lines == ["SIMULATED: sim:walk", "a [mm]", "", "written to out"]
    print_result(console, [], source="real", out=Path("out"))
    assert "SIMULATED" not in console.export_text()


def test_control_characters_in_names_are_escaped():
    console = Console(record=True, width=80, quiet=False)
    out = Path("out\x1b[31m\n")
    print_result(console, [], source="real", out=out, files=[out / "a.csv"])
    assert console.export_text().splitlines() == [
        "", r"written to out\x1b[31m\n:", r"  out\x1b[31m\n/a.csv",
    ]  # fmt: skip


def test_warnings_are_taken_out_in_their_order():
    notes = ("a", "WARNING: b", "c", "WARNING: d")
    assert warnings_first(notes) == (["WARNING: b", "WARNING: d"], ["a", "c"])
