# SPDX-License-Identifier: MIT
"""Every folder under datasets/ is found and held to the same promises."""

import hashlib
import tomllib
from pathlib import Path

import pytest

DATASETS = Path(__file__).parents[2] / "datasets"
FOLDERS = sorted(path for path in DATASETS.iterdir() if path.is_dir() and path.name[0] not in "._")


def files_of(folder):
    """Name every file that ships, relative to its folder."""
    names = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}
    return {name for name in names if "__pycache__" not in name and not name.startswith(".")}


def test_there_are_datasets():
    assert FOLDERS


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_readme_tells_origin_steps_and_licence(folder):
    text = (folder / "README.md").read_text(encoding="utf-8").lower()
    assert text.startswith("# ")
    assert "how it was made" in text
    assert "licen" in text


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_manifest_lists_every_other_file(folder):
    manifest = tomllib.loads((folder / "manifest.toml").read_text(encoding="utf-8"))
    assert set(manifest["files"]) == files_of(folder) - {"manifest.toml"}


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_manifest_hashes_are_those_of_the_files(folder):
    manifest = tomllib.loads((folder / "manifest.toml").read_text(encoding="utf-8"))
    for name, expected in manifest["files"].items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == expected, name
