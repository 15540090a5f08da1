# SPDX-License-Identifier: MIT
"""Ports, CAN interfaces, buffers and disks are judged, and each finding tells what to do."""

import shutil
from types import SimpleNamespace

import pytest
from serial.tools import list_ports

from zebro_lab.recording.doctor import machine as doctor
from zebro_lab.recording.doctor.finding import Grade


def states(findings):
    return {finding.state for finding in findings}


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
