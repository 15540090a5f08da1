# SPDX-License-Identifier: MIT
"""Hashes tie a result to its inputs, and its commit is that of the code which ran."""

import hashlib
import json
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.provenance import (
    CHANGED,
    PACKAGES,
    RECORDED,
    UNKNOWN,
    commit_of,
    file_hash,
    fingerprint,
    software,
    software_commit,
)

SETTINGS = {"law": "brush", "seed": 1, "load_cell": {"gain_sd": 0.01}, "block_length": None}
HASHES = {"a.csv": "1" * 64, "b.csv": "2" * 64}


def test_file_hash_is_sha_256_of_the_content(tmp_path):
    (tmp_path / "a").write_bytes(b"slip\x00" * 100_000)
    assert file_hash(tmp_path / "a") == hashlib.sha256(b"slip\x00" * 100_000).hexdigest()


def test_fingerprint_ignores_names_and_order():
    renamed = {"elsewhere/z.csv": HASHES["a.csv"], "b.csv": HASHES["b.csv"]}
    assert fingerprint(renamed, SETTINGS) == fingerprint(HASHES, SETTINGS)
    turned = dict(reversed(SETTINGS.items()))
    assert fingerprint(HASHES, turned) == fingerprint(HASHES, SETTINGS)


@given(st.sampled_from(sorted(HASHES)), st.text("0123456789abcdef", min_size=64, max_size=64))
def test_fingerprint_changes_with_any_content(name, digest):
    changed = {**HASHES, name: digest}
    same = sorted(changed.values()) == sorted(HASHES.values())
    assert (fingerprint(changed, SETTINGS) == fingerprint(HASHES, SETTINGS)) == same


@given(
    st.sampled_from(sorted(SETTINGS)),
    st.none() | st.integers() | st.text() | st.dictionaries(st.text(), st.floats(allow_nan=False)),
)
def test_fingerprint_changes_with_any_setting(name, value):
    changed = {**SETTINGS, name: value}
    assert (fingerprint(HASHES, changed) == fingerprint(HASHES, SETTINGS)) == (
        json.dumps(value) == json.dumps(SETTINGS[name])
    )


def test_software_names_commit_and_every_version_that_decides_numbers():
    versions = software()
    assert versions.keys() == {"python", *RECORDED, "commit"}
    assert all(versions.values())


ROOT = Path(__file__).resolve().parents[3]
SAYS_COMMIT = "from zebro_lab.files.provenance import software_commit; print(software_commit())"


def git(folder: Path, *command: str) -> str:
    identity = ("-c", "user.name=N", "-c", "user.email=e@example.org")
    told = subprocess.run(("git", "-C", folder, *identity, *command),
                          check=True, capture_output=True, text=True)  # fmt: skip
    return told.stdout.strip()


@pytest.fixture
def checkout(tmp_path):
    for name in PACKAGES:
        (tmp_path / name).mkdir()
        (tmp_path / name / "module.py").write_text("x = 1\n")
    (tmp_path / "notes.md").write_text("notes\n")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--quiet", "-m", "First")
    return tmp_path


@pytest.mark.parametrize(
    ("name", "said"),
    [("model/module.py", CHANGED), ("rig/new.py", CHANGED), ("notes.md", ""), ("data.csv", "")],
)
def test_the_commit_is_the_head_and_changes_of_the_packages_are_said(checkout, name, said):
    (checkout / name).write_text("x = 2\n")
    assert commit_of(checkout) == git(checkout, "rev-parse", "HEAD") + said


def test_a_repository_that_calls_us_is_not_asked(checkout, tmp_path_factory, monkeypatch):
    other = tmp_path_factory.mktemp("other")
    git(other, "init", "--quiet")
    git(other, "commit", "--quiet", "--allow-empty", "-m", "Other")
    head = git(checkout, "rev-parse", "HEAD")
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    assert commit_of(checkout) == head


def test_a_commit_that_cannot_be_known_is_unknown_with_the_reason(checkout, monkeypatch):
    inside = checkout / "site-packages"
    inside.mkdir()
    assert commit_of(inside).startswith(f"{UNKNOWN}the software is neither")
    git(inside, "init", "--quiet")
    assert commit_of(inside) == f"{UNKNOWN}the checkout has no commit yet"
    (checkout / ".git" / "HEAD").write_text("damaged")
    assert commit_of(checkout).startswith(f"{UNKNOWN}git says: fatal: ")
    monkeypatch.setenv("PATH", "")
    assert commit_of(checkout).startswith(f"{UNKNOWN}git cannot be run (")


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="the project is no git checkout here")
def test_the_software_names_the_commit_of_its_own_checkout():
    assert software_commit().removesuffix(CHANGED) == git(ROOT, "rev-parse", "HEAD")


@pytest.mark.long
@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="the project is no git checkout here")
@pytest.mark.parametrize("through", ["wheel", "sdist"])
def test_a_built_package_names_the_commit_it_was_built_from(through, tmp_path):
    clone, built = tmp_path / "clone", tmp_path / "built"
    git(tmp_path, "clone", "--quiet", str(ROOT), str(clone))
    if through == "sdist":
        clone = unpacked_sdist(clone, tmp_path)
    pip = (sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", clone, "-w", tmp_path)
    subprocess.run(pip, check=True)
    zipfile.ZipFile(next(tmp_path.glob("*.whl"))).extractall(built)
    told = subprocess.run((sys.executable, "-c", SAYS_COMMIT), cwd=built, check=True,
                          capture_output=True, text=True)  # fmt: skip
    assert told.stdout.strip() == git(ROOT, "rev-parse", "HEAD")


def unpacked_sdist(clone: Path, place: Path) -> Path:
    """Build an sdist of a clone by hatchling in an environment that pip makes; unpack it."""
    env, out = place / "env", place / "sdist"
    subprocess.run((sys.executable, "-m", "pip", "install", "--quiet", "--target", env,
                    "hatchling"), check=True)  # fmt: skip
    build = "import hatchling.build as b; import sys; b.build_sdist(sys.argv[1])"
    subprocess.run((sys.executable, "-c", build, place), cwd=clone, check=True,
                   env={"PYTHONPATH": str(env), "PATH": "/usr/bin:/bin"})  # fmt: skip
    out.mkdir()
    subprocess.run(("tar", "-xzf", next(place.glob("*.tar.gz")), "-C", out), check=True)
    return next(out.iterdir())
