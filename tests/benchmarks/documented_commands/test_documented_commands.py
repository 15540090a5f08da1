# SPDX-License-Identifier: MIT
"""A made-up page is run and compared."""

import pytest

from benchmarks.documented_commands.__main__ import main
from benchmarks.documented_commands.comparison import compare, without_the_run
from benchmarks.documented_commands.lines import find_lines, shell_lines
from benchmarks.documented_commands.running import read_outcomes

PAGE = """# A page

```sh
zebro-lab write first.csv \\
  --seed 3              # a table
zebro-lab fail
make test
zebro-lab sim rig       # serves until it is stopped
zebro-lab record --rig rig@/dev/ttyUSB0 --label a
zebro-lab sleep
```

What it prints:

```
a table of zebro-lab
zebro-lab write second.csv
```

```python
zebro-lab is not a shell's
```
"""
PROGRAM = """#!/bin/bash
case "$1" in
  write) printf 't,x\\n0,{value}\\n' > "$2"; echo "{word} 2020-01-02T03:04:05 in $PWD" ;;
  fail) echo "no such file" >&2; exit 3 ;;
  sim) trap 'echo stopped > stopped.txt; exit 0' INT; echo "at /tmp/abc/port"
       while true; do sleep 0.05; done ;;
  record) echo "$RANDOM samples"; echo $RANDOM > "$(date +%Y%m%dT%H%M%SZ)_a.txt" ;;
  sleep) sleep 30 ;;
esac
"""


def checkout(folder, *, value="1.5", word="written"):
    (folder / "docs").mkdir(parents=True)
    (folder / "README.md").write_text(PAGE)
    (folder / "Makefile").write_text("demo:\n\tzebro-lab write demo.csv\n\t@echo done\n")
    programs = folder / ".venv" / "bin"
    programs.mkdir(parents=True)
    text = PROGRAM.replace("{value}", value).replace("{word}", word)
    (programs / "zebro-lab").write_text(text)
    (programs / "zebro-lab").chmod(0o755)
    (folder / ".venv" / ".installed").touch()
    return folder


@pytest.fixture
def plain(tmp_path, monkeypatch):
    monkeypatch.setattr("benchmarks.documented_commands.lines.PREPARED", {})
    return checkout(tmp_path / "plain")


def run(place, out, *more):
    assert main(["run", str(place), str(out), "--limit", "0.7", *map(str, more)]) == 0
    return out


def test_lines_of_shells_alone_are_found(plain):
    lines = {line.text: line for line in find_lines(plain)}
    assert list(lines) == [
        "zebro-lab write first.csv --seed 3", "zebro-lab fail", "make test", "zebro-lab sim rig",
        "zebro-lab record --rig rig@/dev/ttyUSB0 --label a", "zebro-lab sleep",
        "zebro-lab write second.csv", "zebro-lab write demo.csv",
    ]  # fmt: skip
    assert lines["make test"].command == ""
    assert lines["zebro-lab sim rig"].serves
    recorded = lines["zebro-lab record --rig rig@/dev/ttyUSB0 --label a"]
    assert recorded.command == "zebro-lab record --rig sim --duration 3 --label a"


def test_a_prompt_marks_the_lines_of_a_console():
    assert shell_lines("```console\n$ zebro-lab runs\nno runs\n```\n") == ["zebro-lab runs"]


def test_a_run_equals_itself_but_for_time_and_place(plain, tmp_path, capsys):
    first, second = run(plain, tmp_path / "one"), run(plain, tmp_path / "two")
    by_text = {each.line.text: each for each in read_outcomes(first)}
    assert by_text["zebro-lab write first.csv --seed 3"].files == ("first.csv",)
    assert by_text["zebro-lab fail"].code == 3
    assert by_text["zebro-lab sleep"].code is None
    assert by_text["make test"].code is None
    assert (first / "work" / "README.md" / "stopped.txt").is_file()
    assert [found for _, found in compare(first, second)] == [[]] * 8
    capsys.readouterr()
    assert main(["compare", str(first), str(second)]) == 0
    said = capsys.readouterr().out
    assert "7 of 7 lines equal" in said


def test_another_number_is_a_fault_and_another_word_is_not(plain, tmp_path):
    first = run(plain, tmp_path / "one")
    other = checkout(tmp_path / "other", value="1.5000000000000002", word="wrote")
    second = run(other, tmp_path / "two", "--lines", first)
    found = {each.line.text: differs for each, differs in compare(first, second)}
    assert found["zebro-lab write first.csv --seed 3"] == [
        "first.csv: -0,1.5; +0,1.5000000000000002"
    ]
    assert not found["zebro-lab fail"]


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("1.234567e-05 and 1.2345678", "1.234567e-05 and 1.2345678"),
        ("at 4427c57 of 1.2.3", "at COMMIT of VERSION"),
        ("sampled in 28 s, after 3 s", "sampled in DURATION, after 3 s"),
        ("run 20200601T120000Z_walk, 2020-06-01", "run TIME_walk, TIME"),
    ],
)
def test_numbers_stay_where_they_are_results(text, left):
    assert without_the_run(text) == left
