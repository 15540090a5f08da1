# SPDX-License-Identifier: MIT
"""Packages, ports, CAN interfaces and disks are judged, and each finding tells what to do."""

import shutil
import sys
from importlib.metadata import PackageNotFoundError
from types import SimpleNamespace

import pytest
from serial.tools import list_ports

from zebro_lab.recording import doctor


def test_a_missing_package_and_a_wrong_version_are_broken_and_others_extras_are_not():
    needed = ["no-such-package>=1", "numpy>=999", "also-missing; extra == 'x'", "scipy>=1"]
    missing, wrong, rest = doctor.check_requirements(needed)
    assert (missing.state, wrong.state, rest.state) == ("BROKEN", "BROKEN", "ok")
    assert "pip install 'no-such-package>=1'" in missing.text
    assert "expected >=999" in wrong.text
    assert "also-missing" not in rest.text


def test_a_copy_that_is_not_installed_is_broken(tmp_path, monkeypatch):
    def missing(name: str) -> str:
        raise PackageNotFoundError(name)

    monkeypatch.setattr(doctor, "version", missing)
    first = next(doctor.examine(tmp_path))
    assert (first.state, first.what) == ("BROKEN", "zebro-lab")
    assert "pip install -e" in first.text


@pytest.mark.parametrize("shadow", ["can.py", "can/notes.txt"])
def test_a_file_or_folder_that_shadows_a_package_is_found(shadow, tmp_path, monkeypatch):
    place = tmp_path / shadow
    place.parent.mkdir(exist_ok=True)
    place.touch()
    for name in [name for name in sys.modules if name.partition(".")[0] == "can"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    (broken,) = [f for f in doctor.check_shadows() if f.what == "module can"]
    assert broken.state == "BROKEN"
    assert str(tmp_path) in broken.text


def test_a_port_without_the_right_to_it_is_noted(monkeypatch):
    ports = [SimpleNamespace(device="/dev/ttyUSB0", description="CP2102")]
    monkeypatch.setattr(list_ports, "comports", lambda: ports)
    (denied,) = doctor.check_serial_ports(may=lambda *_: False)
    assert denied.state == "note"
    assert "usermod -aG" in denied.text
    (allowed,) = doctor.check_serial_ports(may=lambda *_: True)
    assert allowed.state == "ok"
    monkeypatch.setattr(list_ports, "comports", list)
    assert "none found" in next(doctor.check_serial_ports()).text


def test_can_interfaces_are_told_from_others_and_up_from_down(tmp_path):
    for name, kind, flags in (("can0", "280", "0x40081"), ("can1", "280", "0x40080"),
                              ("eth0", "1", "0x1003")):  # fmt: skip
        (tmp_path / name).mkdir()
        (tmp_path / name / "type").write_text(f"{kind}\n")
        (tmp_path / name / "flags").write_text(f"{flags}\n")
    up, down = doctor.check_can(tmp_path)
    assert (up.what, up.state) == ("CAN can0", "ok")
    assert "ip link set can1 up" in down.text
    assert "slcan" in next(doctor.check_can(tmp_path / "none")).text


@pytest.mark.parametrize(("free", "state"), [(1 << 20, "BROKEN"), (1 << 40, "ok")])
def test_room_on_the_disk_is_judged(tmp_path, monkeypatch, free, state):
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=free))
    assert doctor.check_disk(tmp_path / "not" / "yet").state == state
