# SPDX-License-Identifier: MIT
"""The import contracts of pyproject.toml: kept, and broken by each import that they forbid."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).parents[1]
LINT = Path(sys.executable).with_name("lint-imports")

PLANTS = {
    "a lower package imports an upper one": (
        "model/errors.py", "import rig", "imports point down: zebro_lab",
    ),
    "a room imports one above it": (
        "zebro_lab/files/errors.py", "import zebro_lab.walk.folder", "rooms of zebro_lab",
    ),
    "inside a function": (
        "zebro_lab/files/errors.py",
        "def planted():\n    import zebro_lab.walk.folder",
        "rooms of zebro_lab",
    ),
    "for type checking": (
        "zebro_lab/files/errors.py",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import zebro_lab.walk.folder",
        "rooms of zebro_lab",
    ),
    "a room that nobody placed": ("zebro_lab/attic/__init__.py", "", "rooms of zebro_lab"),
    "a circle": ("model/slip/law.py", "import model.slip.laws", "no circles"),
    "model draws": ("model/slip/law.py", "import matplotlib.pyplot", "model opens no file"),
    "a stage draws": ("zebro_lab/walk/folder.py", "import matplotlib.pyplot", "import matplotlib"),
    "a second sampler": ("model/bayes/posterior.py", "import emcee", "imports emcee"),
}  # fmt: skip


@pytest.fixture(scope="module")
def copied(tmp_path_factory) -> Path:
    """Return a folder with the four packages and pyproject.toml."""
    folder = tmp_path_factory.mktemp("checkout")
    for package in ("model", "rig", "tracking", "zebro_lab"):
        shutil.copytree(TOP / package, folder / package, ignore=shutil.ignore_patterns("*.pyc"))
    shutil.copy(TOP / "pyproject.toml", folder)
    return folder


def lint_imports(folder: Path) -> tuple[int, str]:
    """Check the contracts in a folder; return the exit code and what was printed."""
    process = subprocess.run(
        [LINT, "--no-cache"], cwd=folder, capture_output=True, text=True, check=False,
        env=os.environ | {"COLUMNS": "200"},
    )  # fmt: skip
    return process.returncode, process.stdout


def test_the_contracts_are_kept(copied):
    code, printed = lint_imports(copied)
    assert (code, "0 broken" in printed) == (0, True)


@pytest.mark.parametrize("planted", PLANTS)
def test_a_planted_import_breaks_its_contract(copied, planted):
    place, line, contract = PLANTS[planted]
    module = copied / place
    before = module.read_text() if module.is_file() else None
    module.parent.mkdir(exist_ok=True)
    module.write_text((before or "") + f"\n{line}\n")
    try:
        code, printed = lint_imports(copied)
    finally:
        if before is None:
            shutil.rmtree(module.parent)
        else:
            module.write_text(before)
    broken = [each for each in printed.splitlines() if "BROKEN" in each]
    assert code == 1, printed
    assert any(contract in each for each in broken), printed
