# SPDX-License-Identifier: MIT
"""The doctor finds what is planted, tells what to do, and fails only for what is needed."""

import shutil
import sys
from importlib.metadata import requires
from pathlib import Path
from types import SimpleNamespace

import pytest
from serial.tools import list_ports

from zebro_lab.recording import doctor
from zebro_lab.recording.doctor import Grade


def states(findings):
    return {finding.state for finding in findings}


def test_this_machine_has_all_that_is_needed(tmp_path):
    assert Grade.BROKEN not in states(doctor.examine(tmp_path))


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


def test_a_port_without_the_right_to_it_names_its_group(tmp_path, monkeypatch):
    port = tmp_path / "ttyUSB0"
    port.touch()
    denied = doctor.check_port(port, "CP2102", may=lambda *_: False)
    assert denied.state is Grade.NOTE
    assert f"usermod -aG {port.group()}" in denied.text
    assert doctor.check_port(port, "CP2102").state is Grade.OK
    monkeypatch.setattr(list_ports, "comports", list)
    assert "none found" in next(doctor.check_serial_ports()).text


def test_can_interfaces_are_told_from_others_and_up_from_down(tmp_path):
    for name, kind, flags in (("can0", "280", "0x40081"), ("can1", "280", "0x40080"),
                              ("eth0", "1", "0x1003")):  # fmt: skip
        (tmp_path / name).mkdir()
        (tmp_path / name / "type").write_text(f"{kind}\n")
        (tmp_path / name / "flags").write_text(f"{flags}\n")
    up, down = doctor.check_can(tmp_path)
    assert (up.what, up.state) == ("CAN can0", Grade.OK)
    assert "ip link set can1 up" in down.text
    assert "slcan" in next(doctor.check_can(tmp_path / "none")).text


def test_a_small_buffer_for_datagrams_is_noted(tmp_path):
    limit = tmp_path / "rmem_max"
    for granted, state in ((212_992, Grade.NOTE), (doctor.UDP_BUFFER, Grade.OK)):
        limit.write_text(f"{granted}\n")
        assert states(doctor.check_udp(limit)) == {state}
    assert not list(doctor.check_udp(tmp_path / "no"))


@pytest.mark.parametrize(
    ("free", "state"),
    [(1 << 20, Grade.BROKEN), (1 << 30, Grade.NOTE), (1 << 40, Grade.OK)],
)
def test_room_on_the_disk_is_judged(tmp_path, monkeypatch, free, state):
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=free))
    assert doctor.check_disk(tmp_path / "not" / "yet").state is state
