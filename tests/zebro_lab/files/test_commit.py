# SPDX-License-Identifier: MIT
"""The commit that runs and results name is that of the code which ran."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from zebro_lab.files.commit import CHANGED, PACKAGES, UNKNOWN, commit_of, software_commit

ROOT = Path(__file__).resolve().parents[3]
SAYS_COMMIT = "from zebro_lab.files.commit import software_commit; print(software_commit())"


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


def test_the_commit_of_a_checkout_is_its_head(checkout):
    assert commit_of(checkout) == git(checkout, "rev-parse", "HEAD")


@pytest.mark.parametrize("name", ["model/module.py", "rig/new.py"])
def test_changed_and_new_files_of_the_packages_are_said(checkout, name):
    (checkout / name).write_text("x = 2\n")
    assert commit_of(checkout) == git(checkout, "rev-parse", "HEAD") + CHANGED


def test_files_beside_the_packages_do_not_count(checkout):
    (checkout / "notes.md").write_text("more\n")
    (checkout / "data.csv").write_text("1\n")
    assert commit_of(checkout) == git(checkout, "rev-parse", "HEAD")


def test_a_repository_that_calls_us_is_not_asked(checkout, tmp_path_factory, monkeypatch):
    other = tmp_path_factory.mktemp("other")
    git(other, "init", "--quiet")
    git(other, "commit", "--quiet", "--allow-empty", "-m", "Other")
    head = git(checkout, "rev-parse", "HEAD")
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    assert commit_of(checkout) == head


def test_a_folder_inside_somebody_elses_checkout_has_no_commit(checkout):
    inside = checkout / "site-packages"
    inside.mkdir()
    assert commit_of(inside).startswith(f"{UNKNOWN}the software is neither")


def test_a_checkout_without_commits_is_unknown(tmp_path):
    git(tmp_path, "init", "--quiet")
    assert commit_of(tmp_path) == f"{UNKNOWN}the checkout has no commit yet"


def test_the_reason_is_said_where_git_fails(checkout, monkeypatch):
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
