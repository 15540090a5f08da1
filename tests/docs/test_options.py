# SPDX-License-Identifier: MIT
"""Every option that the documentation names is one of the command it stands with, or of any."""

import re
import shlex
from pathlib import Path

import pytest

from benchmarks.documented_commands.lines import find_lines
from support.command_tree import LEAVES

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
OPTION = re.compile(r"(?<![\w/.-])--[a-z][a-z0-9-]+")
OPTIONS = {
    found.words: {"--help", "--install-completion"}.union(
        *((*each.opts, *each.secondary_opts) for each in found.command.params)
    )
    for found in LEAVES
}
OF_OTHERS = {
    option
    for words in (
        "pytest --timeout",
        "dask --host --nworkers --nthreads --no-nanny --no-dashboard",
        "evo_rpe --project --align --pairs --all",
        "benchmarks --commands --inputs --kills --only --seed --seeds --finer --all-pressures",
        "full-toolkit --one-sided --everything --sound --unmarked --exact",
    )
    for option in OPTION.findall(words)
}
"""Options of other programs, and of benchmarks, also of those at the tag."""


@pytest.mark.parametrize("line", [line for line in find_lines(ROOT) if "--" in line.text], ids=str)
def test_a_documented_command_has_the_options_it_is_given(line):
    words = shlex.split(line.text)
    for called, options in OPTIONS.items():
        if words[: len(called)] == list(called):
            assert set(OPTION.findall(line.text)) <= options


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_options_in_the_text_of_a_page_are_options(page):
    every = set().union(*OPTIONS.values()) | OF_OTHERS
    assert set(OPTION.findall(page.read_text(encoding="utf-8"))) - every == set()
