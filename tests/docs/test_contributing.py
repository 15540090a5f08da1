# SPDX-License-Identifier: MIT
"""The recipes name files that are there, and the table names targets that make has."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
FOLDERS = "model|rig|tracking|zebro_lab|tests|benchmarks|docs"


def test_every_file_that_is_named_is_there():
    named = set(re.findall(rf"`((?:{FOLDERS})/[\w./]+)`", TEXT))
    made_up = {name for name in named if re.search("NAME|ROOM|FOLDER|DRIVER", name)}
    assert len(named - made_up) > 20
    assert [name for name in sorted(named - made_up) if not (ROOT / name).exists()] == []


def test_every_benchmark_that_is_named_is_there():
    for name in re.findall(r"`python -m (benchmarks\.[a-z_.]+)`", TEXT):
        place = ROOT / name.replace(".", "/")
        assert place.with_suffix(".py").is_file() or (place / "__main__.py").is_file(), name


def test_every_target_that_is_named_is_one_of_make():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"`make ([a-z-]+)`", TEXT):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
