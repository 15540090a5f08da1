# SPDX-License-Identifier: MIT
"""Versions out of range, shadowed modules and second installations are found and named."""

import sys
from importlib.metadata import requires
from pathlib import Path

import pytest

from zebro_lab.recording.doctor import packages as doctor
from zebro_lab.recording.doctor.finding import Grade


def test_an_old_python_is_broken():
    assert doctor.check_python((3, 10, 4)).state is Grade.BROKEN
    assert "3.11" in doctor.check_python((3, 10, 4)).text


def test_a_missing_package_and_a_wrong_version_are_broken_and_others_extras_are_not():
    needed = ["no-such-package>=1", "numpy>=999", "also-missing; extra == 'x'", "numpy>=1"]
    missing, wrong, rest = doctor.check_requirements(needed)
    assert (missing.state, wrong.state, rest.state) == (
        Grade.BROKEN,
        Grade.BROKEN,
        Grade.OK,
    )
    assert "pip install" in missing.text
    assert "also-missing" not in rest.text


def test_every_dependency_of_the_project_is_looked_at():
    *_, rest = doctor.check_requirements(requires("zebro-lab"))
    assert {"pyserial", "python-can", "mcap", "numpy"} <= {
        each.split()[0] for each in rest.text.split(", ")
    }


@pytest.mark.parametrize("module", ["serial", "can"])
def test_a_module_that_shadows_a_package_is_found(module, tmp_path):
    (tmp_path / f"{module}.py").write_text("")
    found = list(doctor.check_shadows(Path("/"), [str(tmp_path), *sys.path]))
    broken = [f for f in found if f.state is Grade.BROKEN]
    assert [f.what for f in broken] == [f"module {module}"]
    assert str(tmp_path) in broken[0].text


def test_a_file_of_such_a_name_in_the_working_folder_is_noted(tmp_path):
    (tmp_path / "can.py").write_text("")
    notes = [f for f in doctor.check_shadows(tmp_path, sys.path) if f.state is Grade.NOTE]
    assert [f.what for f in notes] == ["module can"]


def test_two_packages_that_bring_one_module_are_broken(monkeypatch):
    both = {"cv2": ["opencv-python", "opencv-python-headless"]}
    monkeypatch.setattr(doctor, "packages_distributions", lambda: both)
    (broken,) = [f for f in doctor.check_shadows(Path("/"), sys.path) if f.state is Grade.BROKEN]
    assert "pip uninstall opencv-python`" in broken.text


def test_a_folder_without_an_init_that_stands_for_a_module_is_named(tmp_path, monkeypatch):
    (tmp_path / "serial").mkdir()
    found = list(doctor.check_shadows(Path("/"), [str(tmp_path)]))
    (broken,) = [f for f in found if f.what == "module serial"]
    assert broken.state is Grade.BROKEN
    assert str(tmp_path / "serial") in broken.text
    assert not any("None" in f.text for f in found)


def test_a_module_that_is_gone_although_its_package_is_there_is_broken(monkeypatch):
    monkeypatch.setattr(doctor.util, "find_spec", lambda _: None)
    found = [f for f in doctor.check_shadows(Path("/"), []) if f.what == "module can"]
    assert [f.state for f in found] == [Grade.BROKEN]
    assert "pip install --force-reinstall python-can" in found[0].text


def test_a_checkout_is_asked_for_its_own_requirements(tmp_path):
    project = tmp_path / "pyproject.toml"
    text = (
        "[project]\nname = '{}'\ndependencies = ['numpy>=99']\n"
        "[project.optional-dependencies]\nx = ['evo>=9']\n"
    )
    project.write_text(text.format("zebro-lab"))
    assert doctor.needed_packages(tmp_path) == ("numpy>=99", "evo>=9; extra == 'x'")
    installed = set(requires("zebro-lab"))
    assert set(doctor.needed_packages(tmp_path / "none")) == installed
    project.write_text(text.format("another"))
    assert set(doctor.needed_packages(tmp_path)) == installed


def installed(place, version, editable=None):
    info = place / f"zebro_lab-{version}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: zebro-lab\nVersion: {version}\n")
    if editable is not None:
        url = f'{{"url": "{editable.as_uri()}", "dir_info": {{"editable": true}}}}'
        (info / "direct_url.json").write_text(url)


def test_the_installation_in_use_is_told_from_others(tmp_path):
    home, site, user = (tmp_path / name for name in ("home page", "site", "user"))
    installed(site, "0.2.0", editable=home)
    installed(user, "0.1.0")
    (tmp_path / "copy" / "zebro_lab").mkdir(parents=True)
    (tmp_path / "copy" / "zebro_lab" / "__init__.py").touch()
    search = [str(place) for place in (home, site, user, user, tmp_path / "copy")]
    used, *others = doctor.check_installations(home, search)
    assert (used.state, used.text) == (Grade.OK, f"version 0.2.0 from {home}")
    assert [f.state for f in others] == [Grade.NOTE] * 2
    assert str(tmp_path / "copy") in others[0].text
    assert str(tmp_path / "user") in others[1].text


def test_a_checkout_that_is_not_installed_is_noted(tmp_path):
    (only,) = doctor.check_installations(tmp_path, [str(tmp_path)])
    assert only.state is Grade.NOTE
    assert f"pip install --editable {tmp_path}" in only.text


def test_an_optional_package_of_another_version_is_noted(monkeypatch):
    monkeypatch.setattr(doctor, "needed_packages", lambda: ("evo>=999; extra == 'evo'",))
    (evo,) = [f for f in doctor.check_optional() if f.what == "evo"]
    assert evo.state is Grade.NOTE
    assert "expected >=999" in evo.text
