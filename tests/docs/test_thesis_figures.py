# SPDX-License-Identifier: MIT
"""The page of the thesis's figures: valid commands, pictures that are made, none left out."""

import re
import shlex
from pathlib import Path

import pytest
import typer

from benchmarks.documented_commands.lines import find_lines, shell_lines
from benchmarks.documented_commands.running import run_lines
from zebro_lab.main import app
from zebro_lab.walk import stage
from zebro_lab.walk.folder import FILES

CHECKOUT = Path(__file__).parents[2]
PAGE = CHECKOUT / "docs" / "thesis-figures.md"
TEXT = PAGE.read_text(encoding="utf-8")
WALKS = [line for line in shell_lines(TEXT) if re.match("zebro-lab walk --gait", line)]
PICTURES = re.findall(r"`([\w-]+/[\w.]+\.png)`", TEXT)
FIGURES = ("2-1", "2-2", "2-3", "2-4", "2-5", "2-6", "4-14", "4-15", "4-16",
           *(f"5-{n}" for n in range(1, 26)))  # fmt: skip


class AskedError(Exception):
    """Holds the request that a command was run with."""


def asked(line, monkeypatch):
    """Return the request of a `zebro-lab walk` line, which is not walked."""

    def walk(request, watcher):
        raise AskedError(request)

    monkeypatch.setattr(stage, "walk", walk)
    with pytest.raises(AskedError) as caught:
        typer.main.get_command(app)(shlex.split(line)[1:], standalone_mode=False)
    return caught.value.args[0]


@pytest.mark.parametrize("line", WALKS)
def test_every_walk_of_the_page_is_a_valid_command_that_draws(line, monkeypatch):
    request = asked(line, monkeypatch)
    assert request.model.pictures.figures
    assert f"--out {request.out} " in line


def test_every_figure_of_the_thesis_is_on_the_page_and_its_tables():
    listed = re.findall(r"^\| ([^|]*) \|", TEXT, flags=re.MULTILINE)
    named = {number for cell in listed for number in numbers_in(cell)}
    assert set(FIGURES) <= named
    assert {"Table 3-1", "Eq. (3-33)", "5-1", "5-2", "5-3", "5-4", "5-5"} <= set(listed) | named


def numbers_in(cell: str) -> set[str]:
    """Return the numbers of figures in a cell: single ones, and all of "5-20 to 5-22"."""
    found = set(re.findall(r"\d-\d+", cell))
    for chapter, first, last in re.findall(r"(\d)-(\d+) to \1-(\d+)", cell):
        found |= {f"{chapter}-{n}" for n in range(int(first), int(last) + 1)}
    return found


def test_pictures_that_the_page_names_are_files_of_its_walks():
    folders = set(re.findall(r"--out (\S+)", "\n".join(shell_lines(TEXT))))
    for picture in PICTURES:
        folder, name = picture.split("/")
        assert folder in folders, picture
        assert name in (*FILES, "curves.png", "surface.png", "comparison.png"), picture


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_every_command_of_the_page_makes_the_pictures_it_names(tmp_path):
    lines = [line for line in find_lines(CHECKOUT) if line.page == "docs/thesis-figures.md"]
    programs = CHECKOUT / ".venv" / "bin"
    outcomes = run_lines(lines, tmp_path / "out", inputs=CHECKOUT, programs=programs, limit=900.0)
    assert [outcome.line.text for outcome in outcomes if outcome.code != 0] == []
    made = {Path(file).as_posix() for outcome in outcomes for file in outcome.files}
    assert set(PICTURES) <= made
